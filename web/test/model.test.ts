import { deflateRawSync } from 'node:zlib';
import { describe, expect, test } from 'vitest';
import { matchRows, levelOf, regionAt, relink, unrelink } from '../src/model/matches';
import { parseMetres } from '../src/model/metres';
import { isReflected, withPending } from '../src/model/pending';
import { addWall, countWalls, documentOf, draftFrom, toggleWall, wallAt, withScale } from '../src/model/plan_draft';
import { formatAge, formatMetres, linkWord, localisationQuality, sortGoals } from '../src/model/status';
import { TileStore } from '../src/model/tiles';
import { emptyHistory, record, redo, undo } from '../src/model/undo';
import { apply, kEmptyWorld, type World, worldFromSnapshot } from '../src/model/world';
import type { Command } from '../src/wire/commands';
import { parseLayoutDocument } from '../src/wire/layout_document';
import type { Goal, Robot } from '../src/wire/parts';
import { kTileCells, type TileFrame } from '../src/wire/tile_frame';

const delta = (part: string, set: Record<string, unknown>, options: { rev?: number; reset?: boolean; del?: string[] } = {}) => ({
  part,
  set,
  rev: options.rev ?? 1,
  reset: options.reset ?? false,
  del: options.del ?? [],
});

function grown(world: World, ...deltas: ReturnType<typeof delta>[]): World {
  return deltas.reduce((so_far, next) => {
    const applied = apply(so_far, next);
    if (!applied.ok) throw new Error(applied.reason);
    return applied.world;
  }, world);
}

const stroke = (points: [number, number][]) => ({ kind: 'wall', author: 'Bo', width: 3, points });

describe('the world', () => {
  test('grows by id, forgets by id, and starts over on reset', () => {
    let world = grown(kEmptyWorld, delta('strokes', { a: stroke([[0, 0]]), b: stroke([[1, 1]]) }));
    world = grown(world, delta('strokes', { c: stroke([[2, 2]]) }, { rev: 2, del: ['a'] }));
    expect([...world.tables.strokes.keys()]).toEqual(['b', 'c']);
    world = grown(world, delta('strokes', { d: stroke([[3, 3]]) }, { rev: 3, reset: true }));
    expect([...world.tables.strokes.keys()]).toEqual(['d']);
  });
  test('is never changed in place', () => {
    const before = grown(kEmptyWorld, delta('strokes', { a: stroke([[0, 0]]) }));
    const table = before.tables.strokes;
    const after = grown(before, delta('strokes', {}, { rev: 2, del: ['a'] }));
    expect(table.size).toBe(1);
    expect(after.tables.walls).toBe(before.tables.walls);
  });
  test('refuses what is older than it knows, takes several deltas of one revision, and a reset of any', () => {
    const world = grown(kEmptyWorld, delta('walls', {}, { rev: 5 }), delta('walls', {}, { rev: 5 }));
    expect(apply(world, delta('walls', {}, { rev: 4 }))).toEqual({ ok: false, reason: 'stale' });
    expect(apply(world, delta('walls', {}, { rev: 1, reset: true })).ok).toBe(true);
    expect(apply(world, delta('weather', {}))).toEqual({ ok: false, reason: 'unknown part' });
  });
  test('counts what did not fit', () => {
    const applied = apply(kEmptyWorld, delta('strokes', { good: stroke([[0, 0]]), bad: { kind: 'circle' } }));
    expect(applied).toMatchObject({ ok: true, dropped: 1 });
    expect(apply(kEmptyWorld, delta('info', { floor: 7 }))).toMatchObject({ ok: true, dropped: 1 });
  });
  test('knows where the plan lies once it has both the mesh and its nodes, and moves the nodes alone', () => {
    const mesh = { px: [[0, 0], [9, 0], [0, 9]], triangles: [[0, 1, 2]] };
    const map = [[0, 0], [1, 0], [0, 1]];
    expect(grown(kEmptyWorld, delta('info', { plan_mesh: mesh })).planMesh).toBeNull();
    const laid = grown(kEmptyWorld, delta('info', { plan_mesh: mesh, plan_nodes: { map } }));
    expect(laid.planMesh).toEqual({ ...mesh, map });
    const moved = [[5, 5], [6, 5], [5, 6]];
    expect(grown(laid, delta('info', { plan_nodes: { map: moved } }, { rev: 2 })).planMesh).toEqual({ ...mesh, map: moved });
    expect(grown(laid, delta('info', {}, { rev: 2, del: ['plan_nodes'] })).planMesh).toBeNull();
  });
  test('of the past comes from a snapshot', () => {
    const world = worldFromSnapshot({ strokes: { a: stroke([[0, 0]]) }, info: { floor: { stopped: true }, sketch: { size: [10, 20] } } });
    expect(world.tables.strokes.size).toBe(1);
    expect(world.floor?.stopped).toBe(true);
    expect(world.sheet.size).toEqual([10, 20]);
  });
});

describe('waiting acts', () => {
  const pending = (...commands: Command[]) => commands.map((command, i) => ({ id: String(i), command, createdMs: 1000 }));
  const add = (id: string): Command => ({ name: 'add_stroke', data: { stroke_id: id, kind: 'wall', width: 3, points: [[1, 1]] } });
  test('show before the server knows of them, in order', () => {
    const world = withPending(kEmptyWorld, pending(add('a'), add('b'), { name: 'erase_stroke', data: { stroke_id: 'a', restore: false } }), 'Anna');
    expect([...world.tables.strokes.keys()]).toEqual(['b']);
    expect(world.tables.strokes.get('b')?.author).toBe('Anna');
    expect(kEmptyWorld.tables.strokes.size).toBe(0);
  });
  test('without any, the world is the same object', () => {
    expect(withPending(kEmptyWorld, [], 'Anna')).toBe(kEmptyWorld);
  });
  test('a mark on the sketch has no place on the map until the server finds one', () => {
    const mark: Command = { name: 'place_poi', data: { poi_id: 'p', kind: 'fire', frame: 'sketch_px', p: [5, 5], label: '' } };
    const world = withPending(kEmptyWorld, pending(mark), 'Anna');
    expect(world.tables.pois.get('p')).toMatchObject({ map: null, author: 'Anna', created_ms: 1000 });
    const onMap = withPending(kEmptyWorld, pending({ ...mark, data: { ...mark.data, frame: 'map' } } as Command), 'Anna');
    expect(onMap.tables.pois.get('p')?.map).toEqual([5, 5]);
  });
  test('are over when the world shows them', () => {
    const world = grown(kEmptyWorld, delta('strokes', { a: stroke([[1, 1]]) }));
    expect(isReflected(world, add('a'))).toBe(true);
    expect(isReflected(world, add('b'))).toBe(false);
    expect(isReflected(world, { name: 'erase_stroke', data: { stroke_id: 'a', restore: false } })).toBe(false);
    expect(isReflected(world, { name: 'remove_poi', data: { poi_id: 'x' } })).toBe(true);
  });
});

describe('undo', () => {
  const act = (name: string) => ({ forward: [`do ${name}`], backward: [`undo ${name}`] });
  test('takes back the latest, redo repeats it, a new act forgets what was undone', () => {
    let history = record(record(emptyHistory<string>(), act('a')), act('b'));
    const back = undo(history)!;
    expect(back.commands).toEqual(['undo b']);
    expect(redo(back.history)!.commands).toEqual(['do b']);
    expect(redo(back.history)!.history).toEqual(history);
    history = record(back.history, act('c'));
    expect(redo(history)).toBeUndefined();
    expect(undo(emptyHistory())).toBeUndefined();
  });
  test('forgets what lies very far back', () => {
    let history = emptyHistory<string>();
    for (let i = 0; i < 500; i++) history = record(history, act(String(i)));
    expect(history.done).toHaveLength(200);
    expect(undo(history)!.commands).toEqual(['undo 499']);
  });
});

describe('the sensed map', () => {
  const packed = (code: number): Uint8Array => new Uint8Array(deflateRawSync(Buffer.alloc((kTileCells * kTileCells) / 2, code | (code << 4))));
  const frame = (seq: number, content: number | Uint8Array, options: { epoch?: number; version?: number } = {}): TileFrame => ({
    type: 'tiles',
    layer: 0,
    epoch: options.epoch ?? 1,
    seq,
    serverMs: 0,
    tiles: [{ tx: 0, ty: 0, version: options.version ?? seq, content }],
  });
  test('keeps the newest of each tile whatever the order of arrival', async () => {
    const store = new TileStore();
    await Promise.all([store.add(frame(5, packed(3))), store.add(frame(7, 9)), store.add(frame(6, packed(4)))]);
    expect(store.tiles.get('0,0')).toMatchObject({ version: 7 });
    expect(store.tiles.get('0,0')!.cells[100]).toBe(9);
    expect(store.position).toEqual({ epoch: 1, seq: 7 });
  });
  test('forgets everything when the server is another run', async () => {
    const store = new TileStore();
    const told: unknown[] = [];
    await store.add(frame(5, 3));
    store.listen((changed) => told.push(changed === 'all' ? 'all' : changed.length));
    await store.add(frame(1, 4, { epoch: 2 }));
    expect(told).toEqual(['all', 1]);
    expect(store.position).toEqual({ epoch: 2, seq: 1 });
    expect(store.tiles.get('0,0')!.cells[0]).toBe(4);
  });
  test('does not count a broken tile as had', async () => {
    const store = new TileStore();
    await store.add(frame(5, 3));
    expect(await store.add(frame(6, new Uint8Array([1, 2, 3])))).toEqual({ broken: 1 });
    expect(store.position.seq).toBe(5);
    expect(store.tiles.get('0,0')!.cells[0]).toBe(3);
  });
  test('is complete after the end of the snapshot', async () => {
    const store = new TileStore();
    expect(store.complete).toBe(false);
    await store.add({ ...frame(1, 0), type: 'end_of_snapshot', tiles: [] });
    expect(store.complete).toBe(true);
  });
});

describe('a plan being prepared', () => {
  const document = parseLayoutDocument({
    size: [100, 100],
    walls: [[0, 0, 100, 0, 4], [100, 0, 100, 100, 6], [0, 50, 100, 50, 4]],
    wall_confidence: [0.9, 0.8, 0.3],
    signs: [{ x: 1 }],
  })!;
  const draft = draftFrom('plan', '/r', document);
  test('a tap finds the nearest wall within reach', () => {
    expect(wallAt(draft, [50, 3], 5)).toBe(0);
    expect(wallAt(draft, [50, 30], 5)).toBeUndefined();
  });
  test('walls that are off are not sent; corners are shared and numbered anew', () => {
    const sent = documentOf(addWall(toggleWall(draft, 2), [0, 0], [0, 100]));
    expect(sent.walls).toEqual([[0, 0, 100, 0, 4], [100, 0, 100, 100, 6], [0, 0, 0, 100, 4]]);
    expect(sent.corners).toEqual([[0, 0], [100, 0], [100, 100], [0, 100]]);
    expect(sent.wall_corners).toEqual([[0, 1], [1, 2], [0, 3]]);
    expect(sent.wall_by_person).toEqual([false, false, true]);
    expect(sent['signs']).toEqual([{ x: 1 }]);
    expect(sent.rectified).toBe('/r');
  });
  test('what a person touched is no longer doubtful', () => {
    expect(countWalls(draft)).toEqual({ on: 3, doubtful: 1, off: 0 });
    expect(countWalls(toggleWall(draft, 2))).toEqual({ on: 2, doubtful: 0, off: 1 });
    expect(countWalls(toggleWall(toggleWall(draft, 2), 2))).toEqual({ on: 3, doubtful: 0, off: 0 });
  });
  test('a scale needs two points apart and a length', () => {
    const scaled = withScale(draft, [0, 0], [0, 50], 2.5)!;
    expect(documentOf(scaled)).toMatchObject({ metres_per_pixel: 0.05, scale_by_person: true });
    expect(withScale(draft, [0, 0], [0, 0], 2)).toBeUndefined();
    expect(withScale(draft, [0, 0], [0, 9], NaN)).toBeUndefined();
    expect(withScale(draft, [0, 0], [0, 9], -1)).toBeUndefined();
  });
});

describe('matches', () => {
  const world = grown(
    kEmptyWorld,
    delta('pairs', {
      '1-4': { sketch: 1, plan: 4, confidence: 0.9, verdict: 'proposed' },
      '2-5': { sketch: 2, plan: 5, confidence: 0.4, verdict: 'proposed' },
      '3-6': { sketch: 3, plan: 6, confidence: 0.2, verdict: 'confirmed' },
      '3-7': { sketch: 3, plan: 7, confidence: 0.9, verdict: 'rejected' },
    }),
  );
  const rows = matchRows(world);
  test('come worst first, what a person kept last, what a person rejected never', () => {
    expect(rows.map((row) => row.id)).toEqual(['2-5', '1-4', '3-6']);
    expect(['sure', 'likely', 'doubtful']).toEqual([0.8, 0.5, 0.49].map(levelOf));
  });
  test('linking a room rejects what said otherwise, on both sides', () => {
    expect(relink(rows, 1, 5)).toEqual([
      { sketch: 2, plan: 5, verdict: 'rejected' },
      { sketch: 1, plan: 4, verdict: 'rejected' },
      { sketch: 1, plan: 5, verdict: 'confirmed' },
    ]);
    expect(relink(rows, 1, 4)).toEqual([{ sketch: 1, plan: 4, verdict: 'confirmed' }]);
  });
  test('a tap where outlines overlap means the smaller room, and nothing beside all of them', () => {
    const square = (x: number, side: number) => ({ outline: [[x, 0], [x + side, 0], [x + side, side], [x, side]] as const });
    const regions = new Map([['1', square(0, 100)], ['2', square(10, 20)], ['3', square(90, 30)]]);
    expect([[15, 5], [50, 50], [95, 5], [119, 29], [300, 0]].map((p) => regionAt(regions, p as [number, number]))).toEqual([2, 1, 3, 3, undefined]);
  });
  test('and can be taken back', () => {
    expect(unrelink(rows, 1, 5)[0]).toEqual({ sketch: 1, plan: 5, verdict: 'proposed' });
    expect(unrelink(rows, 1, 4)).toEqual([{ sketch: 1, plan: 4, verdict: 'proposed' }]);
  });
});

describe('words for numbers', () => {
  test('ages are short and honest', () => {
    expect([0, 1234, 12_340, 240_000, 8_000_000].map(formatAge)).toEqual(['0.0 s', '1.2 s', '12 s', '4 min', '2 h']);
    expect([0.123, 3.456, 27.8].map(formatMetres)).toEqual(['0.12 m', '3.5 m', '28 m']);
  });
  test('a link turns amber after three seconds and red after ten', () => {
    expect([0, 2999, 3000, 9999, 10_000].map((age) => linkWord(true, age))).toEqual(['live', 'live', 'slow', 'slow', 'lost']);
    expect(linkWord(false, 500)).toBe('lost');
    expect(linkWord(false, null)).toBe('connecting');
  });
  test('a robot that is not localised has no quality, however small its sigma', () => {
    const robot = { localized: true, sigma_m: 0.1 } as Robot;
    expect(localisationQuality(robot)).toBe('good');
    expect(localisationQuality({ ...robot, sigma_m: 2 })).toBe('poor');
    expect(localisationQuality({ ...robot, localized: false })).toBe('unknown');
    expect(localisationQuality({ ...robot, sigma_m: null })).toBe('unknown');
  });
  test('open goals come first, oldest first; ended ones newest first', () => {
    const goal = (state: Goal['state'], created_ms: number): Goal => ({ state, created_ms }) as Goal;
    const goals = new Map([['a', goal('arrived', 1)], ['b', goal('driving', 5)], ['c', goal('queued', 4)], ['d', goal('failed', 3)]]);
    expect(sortGoals(goals).map(({ id }) => id)).toEqual(['c', 'b', 'd', 'a']);
  });
});

describe('a length as people type it', () => {
  test.each([['4.2', 4.2], ['4,2', 4.2], [' 4,25 m ', 4.25], ['12', 12], ['.5', 0.5], ['7.', 7], ['0.1', 0.1], ['500M', 500]])('%s', (text, metres) =>
    expect(parseMetres(text)).toBeCloseTo(metres, 9));

  test.each(['', ' ', 'm', 'four', '-4', '0', '0.05', '501', '1e2', '4.2.1', '4 2', 'NaN', 'Infinity', '0x10', '4 cm', '٤'])('"%s" is none', (text) =>
    expect(parseMetres(text)).toBeNull());
});
