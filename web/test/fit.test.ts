import { describe, expect, test } from 'vitest';
import type { PlanMesh } from '../src/geometry/mesh';
import { strengthOf } from '../src/map/fit_painter';
import { localStretch, planPlaceAt, shownAnchors } from '../src/model/fit';
import { kEmptyWorld, type World } from '../src/model/world';
import { between, randomSource } from './support/random';

/** A sheet of two by two squares of 100 px, carried by `carry`. */
function sheet(carry: (x: number, y: number) => [number, number]): PlanMesh {
  const px: [number, number][] = [];
  for (let row = 0; row < 3; row++) for (let column = 0; column < 3; column++) px.push([column * 100, row * 100]);
  const triangles: [number, number, number][] = [];
  for (let row = 0; row < 2; row++)
    for (let column = 0; column < 2; column++) {
      const i = row * 3 + column;
      triangles.push([i, i + 1, i + 4], [i, i + 4, i + 3]);
    }
  return { px, map: px.map(([x, y]) => carry(x, y)), triangles };
}
const world = (mesh: PlanMesh | null, anchors: Record<string, { px: [number, number]; map: [number, number]; off_m?: number; outlier?: boolean }> = {}): World => ({
  ...kEmptyWorld,
  planMesh: mesh,
  tables: { ...kEmptyWorld.tables, anchors: new Map(Object.entries(anchors).map(([id, one]) => [id, { outlier: false, ...one }])) },
});

describe('local scale', () => {
  test('is one everywhere when the plan is only moved, turned and mirrored', () => {
    const random = randomSource(4);
    for (let i = 0; i < 20; i++) {
      const [turn, dx, dy] = [between(random, -3, 3), between(random, -9, 9), between(random, -9, 9)];
      const mesh = sheet((x, y) => [0.02 * (x * Math.cos(turn) + y * Math.sin(turn)) + dx, 0.02 * (x * Math.sin(turn) - y * Math.cos(turn)) + dy]);
      const stretches = localStretch(mesh, 0.02);
      expect(stretches).toHaveLength(8);
      for (const { stretch } of stretches) expect(stretch).toBeCloseTo(1, 9);
    }
  });
  test('says where a plan is ten percent longer', () => {
    const mesh = sheet((x, y) => [0.02 * (x <= 100 ? x : 100 + (x - 100) * 1.21), -0.02 * y]);
    const values = localStretch(mesh, 0.02).map(({ stretch }) => Number(stretch.toFixed(3)));
    expect(new Set(values)).toEqual(new Set([1, 1.1]));
  });
  test('without a scale is against the mean of the plan itself', () => {
    const stretches = localStretch(sheet((x, y) => [0.5 * x, -0.5 * y]), null);
    for (const { stretch } of stretches) expect(stretch).toBeCloseTo(1, 9);
  });
  test('leaves out triangles without area or corners', () => {
    const mesh: PlanMesh = { px: [[0, 0], [1, 0], [2, 0]], map: [[0, 0], [1, 0], [2, 0]], triangles: [[0, 1, 2], [0, 1, 9]] };
    expect(localStretch(mesh, 1)).toEqual([]);
  });
  test('colours grow with the distance from one, up to a tenth', () => {
    expect(strengthOf(1)).toBe(0);
    expect(strengthOf(1.05)).toBeCloseTo(strengthOf(0.95), 9);
    expect(strengthOf(1.1)).toBe(strengthOf(1.4));
    expect(strengthOf(1.02)).toBeLessThan(strengthOf(1.08));
  });
});

describe('fixed points', () => {
  const mesh = sheet((x, y) => [0.02 * x, -0.02 * y]);
  test('tell how far the plan is from where they were fixed', () => {
    const [anchor] = shownAnchors(world(mesh, { a: { px: [100, 100], map: [2.3, -2.4] } }));
    expect(anchor!.shown).toEqual([2, -2]);
    expect(anchor!.residualM).toBeCloseTo(0.5, 9);
  });
  test('that contradict the others say so, with the distance that the merge found', () => {
    const [anchor] = shownAnchors(world(mesh, { a: { px: [100, 100], map: [2.3, -2.4], off_m: 1.62, outlier: true } }));
    expect(anchor).toMatchObject({ residualM: 1.62, outlier: true });
  });
  test('say nothing where the plan says nothing', () => {
    expect(shownAnchors(world(mesh, { a: { px: [900, 900], map: [0, 0] } }))[0]!.residualM).toBeUndefined();
    expect(shownAnchors(world(null, { a: { px: [1, 1], map: [0, 0] } }))[0]!.residualM).toBeUndefined();
  });
  test('a place of the map is the place of the plan that lies there, and back', () => {
    const place = planPlaceAt(world(mesh), [1.5, -0.7])!;
    expect(place[0]).toBeCloseTo(75, 6);
    expect(place[1]).toBeCloseTo(35, 6);
    expect(planPlaceAt(world(mesh), [40, 40])).toBeUndefined();
    expect(planPlaceAt(world(null), [1, 1])).toBeUndefined();
  });
});
