import { describe, expect, test } from 'vitest';
import { restoreState, saveState } from '../src/model/saved';
import { type Tile, TileStore } from '../src/model/tiles';
import { apply, kEmptyWorld, type World } from '../src/model/world';
import { Keeper } from '../src/ui/state/keeper';
import { kTileCells } from '../src/wire/tile_frame';
import { FakeSurroundings, settle } from './support/fake_surroundings';
import { between, randomSource } from './support/random';

const kTimes = { heardMs: 1_000, clockOffsetMs: -20, resolutionM: 0.05 };

const tile = (random: () => number, tx: number): Tile => ({
  tx,
  ty: -tx,
  version: Math.floor(between(random, 1, 100)),
  cells: Uint8Array.from({ length: kTileCells * kTileCells }, () => Math.floor(between(random, 0, 16))),
});

function someWorld(random: () => number): World {
  let world = kEmptyWorld;
  let rev = Math.floor(between(random, 1, 1000));
  const put = (part: string, set: Record<string, unknown>): void => {
    const applied = apply(world, { part, rev: rev++, reset: false, set, del: [] });
    if (!applied.ok) throw new Error(applied.reason);
    expect(applied.dropped).toBe(0);
    world = applied.world;
  };
  const point = (): [number, number] => [between(random, -50, 50), between(random, -50, 50)];
  put('walls', Object.fromEntries(Array.from({ length: 5 }, (_, i) => [`w${i}`, { a: point(), b: point(), state: 'confirmed', confidence: random(), moved_m: random() < 0.5 ? null : 0.2 }])));
  put('pois', { p: { kind: 'fire', label: 'Küche', author: 'Anna', created_ms: 5, frame: 'map', p: point(), map: null, sigma_m: null, confidence: null, reason: '', removed: false } });
  put('strokes', { s: { kind: 'wall', author: 'Bo', width: 4, points: [point(), point()] } });
  put('info', { floor: { plan_id: 'a', size: [10, 20], stopped: true }, sketch: { size: [30, 40], warning: 'w' } });
  if (random() < 0.5) put('info', { plan_mesh: { px: [[0, 0], [1, 0], [0, 1]], triangles: [[0, 1, 2]] }, plan_nodes: { map: [point(), point(), point()] } });
  return world;
}

describe('the state on the disk', () => {
  test('comes back as it was, through a structured clone, for any world', () => {
    for (let seed = 1; seed <= 30; seed++) {
      const random = randomSource(seed);
      const world = someWorld(random);
      const tiles = new TileStore();
      tiles.restore(7, 42, [tile(random, 1), tile(random, 2)]);
      const back = restoreState(structuredClone(saveState(world, tiles, kTimes)));
      expect(back?.world).toEqual(world);
      expect(back?.head).toMatchObject({ epoch: 7, seq: 42, ...kTimes });
      for (const kept of back!.tiles) {
        const before = tiles.tiles.get(`${kept.tx},${kept.ty}`)!;
        expect(kept.version).toBe(before.version);
        expect(Buffer.compare(kept.cells, before.cells)).toBe(0);
      }
    }
  });

  test('shares nothing with the live world: what happens later does not change it', () => {
    const random = randomSource(3);
    const world = someWorld(random);
    const saved = saveState(world, new TileStore(), kTimes);
    apply(world, { part: 'walls', rev: 5000, reset: true, set: {}, del: [] });
    expect(Object.keys(saved.parts['walls']!)).toHaveLength(5);
  });

  test('is nothing when it is damaged, of another form, or not there', () => {
    const saved = saveState(kEmptyWorld, new TileStore(), kTimes);
    for (const bad of [null, undefined, 7, {}, { ...saved, format: 2 }, { ...saved, epoch: 'x' }, { ...saved, tiles: null }, { ...saved, tiles: [{ tx: 1 }] }, { ...saved, parts: 3 }]) {
      expect(restoreState(bad)).toBeUndefined();
    }
  });

  test('leaves out single objects that no longer fit and keeps the others', () => {
    const saved = saveState(someWorld(randomSource(5)), new TileStore(), kTimes);
    const damaged = { ...saved, parts: { ...saved.parts, walls: { ...saved.parts['walls'], w1: { state: 'melted' } } } };
    expect([...restoreState(damaged)!.world.tables.walls.keys()]).toEqual(['w0', 'w2', 'w3', 'w4']);
  });

  test('a tile that is restored goes on: older ones from the server lose, newer ones win', async () => {
    const store = new TileStore();
    const random = randomSource(1);
    const kept = { ...tile(random, 4), version: 50 };
    const told: string[] = [];
    store.listen((changed) => told.push(changed === 'all' ? 'all' : String(changed.length)));
    store.restore(7, 90, [kept]);
    const frame = (version: number, code: number) => ({ type: 'tiles', layer: 0, epoch: 7, seq: 91, serverMs: 0, tiles: [{ tx: 4, ty: -4, version, content: code }] }) as const;
    await store.add(frame(40, 3));
    expect(store.tiles.get('4,-4')).toBe(kept);
    await store.add(frame(60, 3));
    expect(store.tiles.get('4,-4')!.cells[0]).toBe(3);
    expect(store.position).toEqual({ epoch: 7, seq: 91 });
    expect(told).toEqual(['all', 'all', '1']);
  });
});

describe('the keeper', () => {
  function keeping() {
    const around = new FakeSurroundings();
    const saved: unknown[] = [];
    let fails = false;
    const storage = {
      loadState: () => Promise.resolve(null),
      saveState: (_: string, state: unknown) => (fails ? Promise.reject(new Error('full')) : Promise.resolve(void saved.push(state))),
    };
    const keeper = new Keeper(storage, around.after);
    let now: unknown = 'first';
    keeper.watch(() => now);
    return { around, saved, keeper, becomes: (state: unknown) => (now = state), fill: () => (fails = true) };
  }

  test('writes soon after the first change, then at most every twenty seconds', async () => {
    const { around, saved, keeper } = keeping();
    keeper.changed();
    await around.pass(2_000);
    expect(saved).toEqual(['first']);
    for (let i = 0; i < 200; i++) {
      keeper.changed();
      await around.pass(100);
    }
    expect(saved).toHaveLength(2);
  });
  test('writes within a second what a person did', async () => {
    const { around, saved, keeper, becomes } = keeping();
    await keeper.flush();
    keeper.changed();
    becomes('after the act');
    keeper.acted();
    await around.pass(1_000);
    expect(saved).toEqual(['first', 'after the act']);
  });
  test('writes nothing while there is nothing to keep, and forgives a full disk', async () => {
    const { saved, keeper, becomes, fill } = keeping();
    becomes(undefined);
    await keeper.flush();
    expect(saved).toEqual([]);
    becomes('something');
    fill();
    await expect(keeper.flush()).resolves.toBeUndefined();
    await settle();
  });
});
