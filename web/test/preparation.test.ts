import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { addWall, closeOpening, documentOf, draftFrom, nameOpening, openingAt, toggleWall } from '../src/model/plan_draft';
import {
  asRead,
  begun,
  canRedo,
  canUndo,
  type Edit,
  edited,
  editOf,
  kNothingPrepared,
  type Preparation,
  redone,
  restorePreparation,
  undone,
} from '../src/model/preparation';
import { parseLayoutDocument } from '../src/wire/layout_document';
import { between, randomSource } from './support/random';

const example = parseLayoutDocument(JSON.parse(readFileSync(fileURLToPath(new URL('../../proto/examples/layout.json', import.meta.url)), 'utf8')))!;
const draft = draftFrom('plan', '/rectified', example);
const kCorners = [[0, 0], [10, 0], [10, 10], [0, 10]] as const;
const read = (): Preparation => asRead(begun({ planId: 'plan', width: 800, height: 600 }, kCorners), { draft });

/** Something that a person might do next. */
function act(random: () => number, state: Preparation): Partial<Edit> {
  const now = editOf(state).draft!;
  const choice = Math.floor(between(random, 0, 4));
  if (choice === 0) return { draft: toggleWall(now, Math.floor(between(random, 0, now.walls.length))) };
  if (choice === 1) return { draft: addWall(now, [random() * 800, random() * 600], [random() * 800, random() * 600]) };
  if (choice === 2) return { start: { p: [random() * 800, random() * 600], heading: random() } };
  return { corners: kCorners.map(([x, y]) => [x + random(), y + random()] as const) };
}

describe('steps of preparing a plan', () => {
  test('can be taken back to the first reading, one by one, and done again, whatever they were', () => {
    for (let seed = 1; seed <= 50; seed++) {
      const random = randomSource(seed);
      const first = read();
      const states = [first];
      for (let i = 0; i < 20; i++) states.push(edited(states.at(-1)!, act(random, states.at(-1)!)));
      let state = states.at(-1)!;
      for (const before of states.slice(0, -1).toReversed()) {
        state = undone(state);
        expect(editOf(state)).toBe(editOf(before));
      }
      expect(canUndo(state)).toBe(false);
      expect(undone(state)).toBe(state);
      for (const after of states.slice(1)) {
        state = redone(state);
        expect(editOf(state)).toBe(editOf(after));
      }
      expect(canRedo(state)).toBe(false);
    }
  });

  test('a new step forgets what was taken back', () => {
    const two = edited(edited(read(), { corners: [] }), { start: { p: [1, 2], heading: 0 } });
    const other = edited(undone(two), { corners: kCorners });
    expect(canRedo(other)).toBe(false);
    expect(editOf(other).start).toBeNull();
  });

  test('the reader\'s own work is no step: there is nothing to take back before the first', () => {
    expect(canUndo(read())).toBe(false);
    expect(read().taps).toBe(0);
  });

  test('reading again after corners were moved can be taken back, corrections included', () => {
    const corrected = edited(read(), { draft: toggleWall(draft, 0) });
    const again = asRead(corrected, { draft: draftFrom('plan', '/other', example) });
    expect(editOf(again).draft!.rectified).toBe('/other');
    expect(editOf(undone(again)).draft!.walls[0]!.on).toBe(false);
  });

  test('every touch is counted, taking back included: that is what correcting costs', () => {
    let state = read();
    state = edited(state, { corners: [] });
    state = undone(state);
    state = redone(state);
    state = redone(state);
    expect(state.taps).toBe(3);
  });

  test('very old steps are let go, the newest stay', () => {
    let state = read();
    for (let i = 0; i < 200; i++) state = edited(state, { start: { p: [i, 0], heading: 0 } });
    expect(state.edits.length).toBe(60);
    expect(editOf(state).start!.p[0]).toBe(199);
    for (let i = 0; i < 59; i++) state = undone(state);
    expect(canUndo(state)).toBe(false);
    expect(editOf(state).start!.p[0]).toBe(140);
  });

  test('come back from the disk as they were; anything else is nothing prepared', () => {
    const state = { ...edited(read(), { draft: nameOpening(draft, 0, 'window') }), sent: true };
    expect(restorePreparation(structuredClone(state))).toEqual(state);
    for (const bad of [null, 'x', {}, { ...state, format: 0 }, { ...state, at: 7 }, { ...state, at: 1.5 }, { ...state, edits: [{}] }, { ...state, edits: [{ corners: [], draft: { walls: [] } }], at: 0 }]) {
      expect(restorePreparation(bad)).toBe(kNothingPrepared);
    }
  });

  test('what was put in use is not in use any more after the next step', () => {
    const sent = { ...read(), sent: true };
    expect(edited(sent, { corners: [] }).sent).toBe(false);
    expect(undone({ ...edited(sent, { corners: [] }), sent: true }).sent).toBe(false);
  });
});

describe('gaps between walls', () => {
  test('are found on their middle half; at their ends a finger means the wall', () => {
    expect(openingAt(draft, [403, 400], 5)).toBe(0);
    expect(openingAt(draft, [400, 382], 3)).toBeUndefined();
    expect(openingAt(draft, [450, 400], 20)).toBeUndefined();
  });
  test('keep what a person says about them, for sure, through the document', () => {
    const named = nameOpening(draft, 0, 'window');
    expect(documentOf(named)).toMatchObject({ doors: [[400, 380, 400, 420]], door_kinds: ['window'], door_confidence: [1] });
    expect(documentOf(draft)).toMatchObject({ door_kinds: ['door'], door_confidence: [0.9] });
  });
  test('that are none become a wall through, and nothing else changes', () => {
    const closed = closeOpening(draft, 0);
    expect(closed.openings).toEqual([]);
    expect(closed.walls.slice(0, -1)).toEqual(draft.walls);
    expect(closed.walls.at(-1)).toMatchObject({ a: [400, 380], b: [400, 420], on: true, byPerson: true });
    expect(closeOpening(draft, 9)).toBe(draft);
  });
  test('without kinds are doors, as the minimal document says nothing', () => {
    const bare = draftFrom('plan', '/r', { ...example, door_kinds: [], door_confidence: [] });
    expect(bare.openings).toEqual([{ a: [400, 380], b: [400, 420], kind: 'door', confidence: 1 }]);
  });
  test('a document that goes out and comes in is the same', () => {
    const again = parseLayoutDocument(JSON.parse(JSON.stringify(documentOf(draft))))!;
    expect(draftFrom('plan', '/rectified', again)).toMatchObject({ walls: draft.walls.map(({ a, b }) => ({ a, b })), openings: draft.openings });
  });
});
