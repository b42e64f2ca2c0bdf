/** Who may import whom: lower floors only, `link` from `wire` only. Reads every import, like tests/architecture for C++. */
import { readdirSync, readFileSync } from 'node:fs';
import { dirname, join, relative, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, test } from 'vitest';

const kSource = fileURLToPath(new URL('../src/', import.meta.url));
const kFloors: Readonly<Record<string, readonly string[]>> = {
  geometry: [],
  offline: [],
  wire: ['geometry'],
  link: ['wire'],
  model: ['geometry', 'wire'],
  map: ['geometry', 'wire', 'model'],
  tools: ['geometry', 'wire', 'model', 'map'],
  ui: ['geometry', 'wire', 'model', 'map', 'tools', 'link'],
  app: ['geometry', 'wire', 'model', 'map', 'tools', 'link', 'ui'],
};
const kHomes: Readonly<Record<string, readonly string[]>> = {
  ol: ['map'],
  'perfect-freehand': ['map'],
  idb: ['link'],
  valibot: ['wire', 'model'],
  svelte: ['ui', 'app'],
};

const files = readdirSync(kSource, { recursive: true, encoding: 'utf8' }).filter((name) => /\.(ts|svelte)$/.test(name));
const importsOf = (file: string): string[] =>
  [...readFileSync(join(kSource, file), 'utf8').matchAll(/(?:from|import)\s*\(?\s*'([^']+)'/g)].map((match) => match[1]!);
const folderOf = (path: string): string => path.split('/')[0]!;

test('modules import lower floors only', () => {
  const wrong: string[] = [];
  for (const file of files) {
    const from = folderOf(file);
    for (const name of importsOf(file).filter((name) => name.startsWith('.'))) {
      const to = folderOf(relative(kSource, resolve(dirname(join(kSource, file)), name)));
      if (to !== from && !kFloors[from]?.includes(to)) wrong.push(`${file} may not import ${to}`);
    }
  }
  expect(wrong).toEqual([]);
});

test('every library has one home', () => {
  const wrong: string[] = [];
  for (const file of files) {
    for (const name of importsOf(file).filter((name) => !name.startsWith('.'))) {
      if (!kHomes[folderOf(name)]?.includes(folderOf(file))) wrong.push(`${file} may not import ${name}`);
    }
  }
  expect(wrong).toEqual([]);
});

test('no file is longer than 400 lines', () => {
  const long = files.filter((file) => readFileSync(join(kSource, file), 'utf8').split('\n').length > 400);
  expect(long.filter((file) => !/words_/.test(file))).toEqual([]);
});

test('styles and text never enter the page as markup', () => {
  const wrong = files.filter((file) => /\{@html|innerHTML|\bstyle="/.test(readFileSync(join(kSource, file), 'utf8')));
  expect(wrong).toEqual([]);
});
