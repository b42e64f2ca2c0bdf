import { describe, expect, test } from 'vitest';
import { snapAngle, wrapAngle } from '../src/geometry/angle';
import { boundsOf, isEmpty, kNoBounds } from '../src/geometry/bounds';
import { moveView, uncovered, zoomAbout } from '../src/geometry/gesture';
import { mapToPlan, type PlanMesh, planToMap, triangleAffine } from '../src/geometry/mesh';
import { distance, layoutPx, mapPoint, pixelToView, screenPoint, viewPoint, viewToLayout, type Xy } from '../src/geometry/points';
import { centroid, contains, interiorPoint, signedArea } from '../src/geometry/polygon';
import { distanceToPolyline, distanceToSegment, nearestOnSegment } from '../src/geometry/segment';
import { applyAffine, fitSimilarity, invertAffine, toScreen, toView, viewToScreenAffine, type ViewState } from '../src/geometry/similarity';
import { densify, simplify } from '../src/geometry/simplify';
import { snapToWalls } from '../src/geometry/snap';
import { between, randomSource } from './support/random';

const size = { width: 1180, height: 820 };
const limits = { minResolution: 0.001, maxResolution: 10 };
const near = (a: Xy, b: Xy, tolerance = 1e-6): void => expect(distance(a, b)).toBeLessThan(tolerance);

function randomView(random: () => number): ViewState {
  return {
    center: viewPoint(between(random, -50, 50), between(random, -50, 50)),
    resolution: between(random, 0.01, 0.5),
    rotation: between(random, -3, 3),
  };
}

describe('angles', () => {
  test('wrap to [-pi, pi)', () => {
    expect(wrapAngle(Math.PI)).toBeCloseTo(-Math.PI);
    expect(wrapAngle(-Math.PI)).toBeCloseTo(-Math.PI);
    expect(wrapAngle(7)).toBeCloseTo(7 - 2 * Math.PI);
  });
  test('snap only within the tolerance', () => {
    expect(snapAngle(1.5, Math.PI / 2, 0.1)).toBeCloseTo(Math.PI / 2);
    expect(snapAngle(1.2, Math.PI / 2, 0.1)).toBe(1.2);
  });
});

describe('frames', () => {
  test('pixels flip into the view and back unchanged', () => {
    near(pixelToView(layoutPx(3, 4)), [3, -4]);
    near(viewToLayout(pixelToView(layoutPx(3, 4))), [3, 4]);
  });
});

describe('view transforms', () => {
  test('to the screen and back is where one began', () => {
    const random = randomSource(1);
    for (let i = 0; i < 200; i++) {
      const view = randomView(random);
      const p = viewPoint(between(random, -99, 99), between(random, -99, 99));
      near(toView(view, size, toScreen(view, size, p)), p, 1e-9);
    }
  });
  test('the centre of the view is the middle of the canvas, and up is up', () => {
    const view: ViewState = { center: viewPoint(5, 7), resolution: 0.1, rotation: 0 };
    near(toScreen(view, size, viewPoint(5, 7)), [590, 410]);
    near(toScreen(view, size, viewPoint(5, 8)), [590, 400]);
    near(toScreen(view, size, viewPoint(6, 7)), [600, 410]);
  });
  test('a positive rotation turns what is seen clockwise', () => {
    const view: ViewState = { center: viewPoint(0, 0), resolution: 1, rotation: Math.PI / 2 };
    near(toScreen(view, size, viewPoint(0, 10)), [600, 410], 1e-9);
  });
  test('an affine times its inverse is nothing', () => {
    const m = viewToScreenAffine(randomView(randomSource(2)), size);
    near(applyAffine(invertAffine(m), applyAffine(m, [3, 4])), [3, 4], 1e-9);
  });
  test('the best similarity of exact data is exact, mirrored or not', () => {
    const random = randomSource(3);
    for (const mirrored of [false, true]) {
      const from: Xy[] = Array.from({ length: 6 }, () => [between(random, 0, 800), between(random, 0, 600)]);
      const [scale, turn] = [0.02, 0.7];
      const to = from.map(([x, y]): Xy => {
        const v = mirrored ? -y : y;
        return [4 + scale * (Math.cos(turn) * x - Math.sin(turn) * v), -2 + scale * (Math.sin(turn) * x + Math.cos(turn) * v)];
      });
      const fitted = fitSimilarity(from, to, mirrored)!;
      from.forEach((p, i) => near(applyAffine(fitted, p), to[i]!, 1e-9));
    }
    expect(fitSimilarity([[1, 1]], [[2, 2]], false)).toBeUndefined();
  });
});

describe('gestures', () => {
  test('one finger keeps its place on the map', () => {
    const random = randomSource(4);
    for (let i = 0; i < 100; i++) {
      const view = randomView(random);
      const [from, to] = [screenPoint(between(random, 0, 1180), between(random, 0, 820)), screenPoint(between(random, 0, 1180), between(random, 0, 820))];
      const moved = moveView({ view, fingers: [from] }, [to], size, limits);
      near(toView(moved, size, to), toView(view, size, from), 1e-7);
    }
  });
  test('two fingers keep the place between them, and spreading comes closer', () => {
    const view = randomView(randomSource(5));
    const before = [screenPoint(400, 400), screenPoint(600, 400)];
    const after = [screenPoint(300, 420), screenPoint(700, 420)];
    const moved = moveView({ view, fingers: before }, after, size, limits);
    expect(moved.resolution).toBeCloseTo(view.resolution / 2);
    near(toView(moved, size, screenPoint(500, 420)), toView(view, size, screenPoint(500, 400)), 1e-7);
  });
  test('a pinch that turns a little does not turn the map; a quarter turn snaps', () => {
    const view: ViewState = { center: viewPoint(0, 0), resolution: 1, rotation: 0 };
    const grip = { view, fingers: [screenPoint(400, 400), screenPoint(600, 400)] };
    expect(moveView(grip, [screenPoint(400, 390), screenPoint(600, 410)], size, limits).rotation).toBe(0);
    expect(moveView(grip, [screenPoint(515, 300), screenPoint(485, 500)], size, limits).rotation).toBeCloseTo(Math.PI / 2);
  });
  test('zooming stops at the limits and keeps the point under the cursor', () => {
    const view = randomView(randomSource(6));
    const at = screenPoint(100, 700);
    const closer = zoomAbout(view, at, 1e9, size, limits);
    expect(closer.resolution).toBe(limits.minResolution);
    near(toView(closer, size, at), toView(view, size, at), 1e-6);
  });
  test('what a card covers comes out just above it, and nothing else moves', () => {
    const random = randomSource(8);
    const card = { left: 100, right: 720, top: 500, bottom: 730 };
    for (let i = 0; i < 200; i++) {
      const view = randomView(random);
      const at = screenPoint(between(random, 0, size.width), between(random, 0, size.height));
      const p = toView(view, size, at);
      const after = uncovered(view, size, p, card, 56);
      const isCovered = at[0] > 44 && at[0] < 776 && at[1] > 444 && at[1] < 730;
      near(toScreen(after, size, p), isCovered ? screenPoint(at[0], 444) : at, 1e-5);
      expect(after.resolution).toBe(view.resolution);
      expect(after.rotation).toBeCloseTo(view.rotation, 12);
    }
  });
  test('a card that covers nearly everything moves nothing', () => {
    const view = randomView(randomSource(9));
    expect(uncovered(view, size, view.center, { left: 0, right: 1180, top: 90, bottom: 800 }, 56)).toEqual(view);
  });
});

describe('segments and polygons', () => {
  test('the nearest point of a segment beats a brute-force search', () => {
    const random = randomSource(7);
    for (let i = 0; i < 100; i++) {
      const [a, b, p] = [0, 1, 2].map((): Xy => [between(random, -5, 5), between(random, -5, 5)]) as [Xy, Xy, Xy];
      const samples = Array.from({ length: 501 }, (_, k): Xy => [a[0] + ((b[0] - a[0]) * k) / 500, a[1] + ((b[1] - a[1]) * k) / 500]);
      const best = Math.min(...samples.map((q) => distance(p, q)));
      expect(distanceToSegment(p, a, b)).toBeLessThanOrEqual(best + 1e-9);
      expect(distance(p, nearestOnSegment(p, a, b))).toBeGreaterThan(best - 0.03);
    }
  });
  test('a chain without points is infinitely far', () => {
    expect(distanceToPolyline([0, 0], [])).toBe(Infinity);
    expect(distanceToPolyline([0, 3], [[0, 0], [5, 0]])).toBe(3);
  });
  test('a point is inside a concave room as a ray says', () => {
    const room: Xy[] = [[0, 0], [10, 0], [10, 10], [6, 10], [6, 4], [4, 4], [4, 10], [0, 10]];
    expect(contains(room, [5, 2])).toBe(true);
    expect(contains(room, [5, 7])).toBe(false);
    expect(signedArea(room)).toBeCloseTo(88);
    expect(contains(room, interiorPoint(room))).toBe(true);
  });
  test('an interior point is inside even where the centroid is not', () => {
    const horseshoe: Xy[] = [[0, 0], [10, 0], [10, 10], [9, 10], [9, 1], [1, 1], [1, 10], [0, 10]];
    expect(contains(horseshoe, centroid(horseshoe))).toBe(false);
    expect(contains(horseshoe, interiorPoint(horseshoe))).toBe(true);
  });
  test('bounds grow with every point', () => {
    expect(isEmpty(kNoBounds)).toBe(true);
    expect(boundsOf([[1, 2], [-3, 5]])).toEqual({ minX: -3, minY: 2, maxX: 1, maxY: 5 });
  });
});

describe('the bent plan', () => {
  const mesh: PlanMesh = {
    px: [[0, 0], [100, 0], [0, 100], [100, 100]],
    map: [[0, 10], [12, 10], [0, 0], [9, 1]],
    triangles: [[0, 1, 2], [1, 3, 2]],
  };
  test('is exact at its corners and undone by its inverse', () => {
    mesh.px.forEach((px, i) => near(planToMap(mesh, px)!, mesh.map[i]!));
    const random = randomSource(8);
    for (let i = 0; i < 100; i++) {
      const px = layoutPx(between(random, 0, 100), between(random, 0, 100));
      near(mapToPlan(mesh, planToMap(mesh, px)!)!, px, 1e-6);
    }
  });
  test('has no answer outside', () => {
    expect(planToMap(mesh, layoutPx(150, 50))).toBeUndefined();
    expect(mapToPlan(mesh, mapPoint(-5, 5))).toBeUndefined();
  });
  test('its triangles as affines agree with it', () => {
    const m = triangleAffine([[0, 0], [100, 0], [0, 100]], [[0, 10], [12, 10], [0, 0]])!;
    near(applyAffine(m, [20, 30]), planToMap(mesh, layoutPx(20, 30))!);
    expect(triangleAffine([[0, 0], [1, 1], [2, 2]], [[0, 0], [1, 0], [0, 1]])).toBeUndefined();
  });
});

describe('drawing help', () => {
  const walls = [[[0, 0], [100, 0]], [[100, 0], [100, 80]]] as const;
  test('a corner wins over a wall, a wall over nothing', () => {
    expect(snapToWalls([97, 4] as Xy, walls, 8)).toEqual({ p: [100, 0], to: 'corner' });
    expect(snapToWalls([50, 5] as Xy, walls, 8)).toEqual({ p: [50, 0], to: 'wall' });
    expect(snapToWalls([50, 40] as Xy, walls, 8).to).toBe('nothing');
  });
  test('a wall that is nearly upright becomes upright', () => {
    expect(snapToWalls([53, 60] as Xy, [], 8, [50, 20])).toEqual({ p: [50, 60], to: 'axis' });
    expect(snapToWalls([90, 22] as Xy, [], 8, [50, 20])).toEqual({ p: [90, 20], to: 'axis' });
  });
  test('a denser chain has the same shape and keeps every point', () => {
    const chain: Xy[] = [[0, 0], [10, 0], [10, 7]];
    const dense = densify(chain, 3);
    for (const p of chain) expect(dense).toContainEqual(p);
    for (const p of dense) expect(distanceToPolyline(p, chain)).toBeLessThan(1e-9);
    dense.slice(1).forEach((p, i) => expect(distance(p, dense[i]!)).toBeLessThanOrEqual(3 + 1e-9));
    expect(densify([], 3)).toEqual([]);
  });
  test('simplifying stays within its tolerance and keeps both ends', () => {
    const random = randomSource(9);
    const line = Array.from({ length: 300 }, (_, i): Xy => [i, 20 * Math.sin(i / 30) + between(random, -0.4, 0.4)]);
    const kept = simplify(line, 1);
    expect(kept.length).toBeLessThan(60);
    expect([kept[0], kept.at(-1)]).toEqual([line[0], line.at(-1)]);
    for (const p of line) expect(distanceToPolyline(p, kept)).toBeLessThanOrEqual(1 + 1e-9);
  });
});
