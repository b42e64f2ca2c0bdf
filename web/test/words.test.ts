import { expect, test } from 'vitest';
import { kIcons } from '../src/map/icons';
import { kDark, kLight } from '../src/map/palette';
import { colourCells, paletteWords } from '../src/map/grid_painter';
import { kTileCells } from '../src/wire/tile_frame';
import sentences from '../../proto/sentences.json';
import { asSentence, sayer } from '../src/ui/sentences';
import { sentencesDe } from '../src/ui/sentences_de';
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

test('German has every sentence of the server, with the same blanks to fill', () => {
  expect(Object.keys(sentencesDe).sort()).toEqual([...(sentences as string[])].sort());
  for (const [english, german] of Object.entries(sentencesDe)) expect([english, blanks(german)]).toEqual([english, blanks(english)]);
});

test('what the server says is said in German: whole, with blanks, one sentence after the other, one in another', () => {
  const say = sayer(sentencesDe);
  expect(say('something stands in the way')).toBe('etwas steht im Weg');
  expect(say('no progress for 30 s')).toBe('seit 30 s kein Vorankommen');
  expect(say('the robot cannot get on in the smoke: no progress for 12 s')).toBe('der Roboter kommt im Rauch nicht weiter: seit 12 s kein Vorankommen');
  expect(say('the picture could not be processed: bad allocation')).toBe('das Bild ließ sich nicht verarbeiten: bad allocation');
  expect(say('The scale is guessed from a scale bar to 3 percent: measure one length.')).toBe('Der Maßstab ist geschätzt (aus einem Maßstabsbalken), auf 3 Prozent genau: eine Länge messen.');
  expect(say('No closed room was found: walls may be missing. 2 gaps are left open: doors, or close them.')).toBe(
    'Kein geschlossener Raum gefunden: es können Wände fehlen. 2 Lücken bleiben offen: Türen, oder bitte schließen.',
  );
});

test('what no table knows stays as it was said: nothing is lost', () => {
  const say = sayer(sentencesDe);
  for (const text of ['', 'E42', 'a new sentence. With another.', 'toString', '{why}']) expect(say(text)).toBe(text);
  expect(sayer({})('no progress for 30 s')).toBe('no progress for 30 s');
});

test('a sentence that stands alone begins with a capital, a name as it is written', () => {
  expect(asSentence('diese Seite braucht lange')).toBe('Diese Seite braucht lange');
  expect(asSentence('über 40 Megapixel')).toBe('Über 40 Megapixel');
  expect(asSentence('robot1 is silent')).toBe('robot1 is silent');
  expect(asSentence('the picture is cut')).toBe('The picture is cut');
  expect(asSentence('')).toBe('');
});
