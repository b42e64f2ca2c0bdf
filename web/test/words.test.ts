import { expect, test } from 'vitest';
import { kIcons } from '../src/map/icons';
import { kDark, kLight } from '../src/map/palette';
import { colourCells, paletteWords } from '../src/map/grid_painter';
import { kTileCells } from '../src/wire/tile_frame';
import { de } from '../src/ui/words_de';
import { en, type Key } from '../src/ui/words_en';

const blanks = (text: string): string[] => [...text.matchAll(/\{(\w+)\}/g)].map((match) => match[1]!).sort();

test('every language says everything, with the same blanks to fill', () => {
  expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
  for (const key of Object.keys(en) as Key[]) expect([key, blanks(de[key])]).toEqual([key, blanks(en[key])]);
});

test('both themes colour all sixteen cell codes, and tell walls from free space', () => {
  for (const { cells } of [kLight, kDark]) {
    expect(cells).toHaveLength(16);
    const light = (code: number): number => cells[code]!.reduce((sum, value) => sum + value, 0);
    expect(Math.abs(light(1) - light(13))).toBeGreaterThan(300);
  }
});

test('the lowest row of cells is the lowest row of the picture, and unknown is transparent', () => {
  const words = paletteWords(kLight);
  const cells = new Uint8Array(kTileCells * kTileCells);
  cells[3] = 13;
  const out = new Uint32Array(cells.length);
  colourCells(cells, words, out);
  expect(out[(kTileCells - 1) * kTileCells + 3]).toBe(words[13]);
  expect(out[0]).toBe(words[0]);
  expect(words[0]! >>> 24).toBe(0);
  expect(words[13]! >>> 24).toBe(255);
});

test('icons stay on their field', () => {
  for (const [name, path] of Object.entries(kIcons)) {
    expect([name, /^[MmLlHhVvAaCcSsZz0-9 .,-]+$/.test(path)]).toEqual([name, true]);
    expect(path.startsWith('M')).toBe(true);
  }
});
