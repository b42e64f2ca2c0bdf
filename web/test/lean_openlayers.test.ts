/** What the build leaves out of OpenLayers must exist there, and must offer every name that is imported from it. */
import { readdirSync, readFileSync } from 'node:fs';
import { join, posix } from 'node:path';
import { fileURLToPath } from 'node:url';
import { expect, test } from 'vitest';
import { kReplaced } from '../build/lean_openlayers';

const modules = fileURLToPath(new URL('../node_modules/', import.meta.url));
const sources = readdirSync(join(modules, 'ol'), { recursive: true, encoding: 'utf8' })
  .filter((file) => file.endsWith('.js') && !file.startsWith('dist'))
  .map((file) => `ol/${file.replaceAll('\\', '/')}`);
/** Modules that the page reaches: from Map, View, Layer and Projection, not through what is left out. */
function reached(): Map<string, string> {
  const found = new Map<string, string>();
  const open = ['ol/Map.js', 'ol/View.js', 'ol/layer/Layer.js', 'ol/proj/Projection.js'];
  for (let name = open.pop(); name; name = open.pop()) {
    if (found.has(name) || name in kReplaced) continue;
    const text = readFileSync(join(modules, name), 'utf8');
    found.set(name, text);
    for (const [, to] of text.matchAll(/from\s+'(\.[^']+)'/g)) open.push(posix.normalize(posix.join(posix.dirname(name), to!)));
  }
  return found;
}

test('every module that is left out is one of OpenLayers', () => {
  expect(Object.keys(kReplaced).filter((name) => !sources.includes(name))).toEqual([]);
});

test('what is put in its place offers every name that the rest imports', () => {
  const missing: string[] = [];
  for (const [name, text] of reached())
    for (const [, names, from] of text.matchAll(/import\s+([^;]*?)\s+from\s+'(\.[^']+)'/g)) {
      const target = posix.normalize(posix.join(posix.dirname(name), from!));
      const stub = kReplaced[target];
      if (!stub) continue;
      const asked = names!.startsWith('{') ? names!.replace(/[{}\s]/g, '').split(',').filter(Boolean).map((one) => one.split('as')[0]!) : ['default'];
      for (const one of asked) if (!new RegExp(one === 'default' ? 'export default' : `export const ${one}\\b`).test(stub)) missing.push(`${name} imports ${one} from ${target}`);
    }
  expect(missing).toEqual([]);
});

test('each of them is reached at all: nothing is left out for nothing', () => {
  const all = [...reached()].flatMap(([name, text]) => [...text.matchAll(/from\s+'(\.[^']+)'/g)].map(([, to]) => posix.normalize(posix.join(posix.dirname(name), to!))));
  expect(Object.keys(kReplaced).filter((name) => !all.includes(name))).toEqual([]);
});
