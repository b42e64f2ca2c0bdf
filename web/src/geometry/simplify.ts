import type { Xy } from './points';
import { distanceToSegment } from './segment';

/** Ramer-Douglas-Peucker without recursion: drops points that lie within `tolerance` of the chain that remains. */
export function simplify<P extends Xy>(points: readonly P[], tolerance: number): P[] {
  if (points.length < 3) return [...points];
  const keep = new Set([0, points.length - 1]);
  const open: [number, number][] = [[0, points.length - 1]];
  for (let span = open.pop(); span; span = open.pop()) {
    const [first, last] = span;
    let farthest = -1;
    let worst = tolerance;
    for (let i = first + 1; i < last; i++) {
      const off = distanceToSegment(points[i]!, points[first]!, points[last]!);
      if (off > worst) [worst, farthest] = [off, i];
    }
    if (farthest < 0) continue;
    keep.add(farthest);
    open.push([first, farthest], [farthest, last]);
  }
  return points.filter((_, i) => keep.has(i));
}

/** The same chain with points at most `spacing` apart: every given point stays. */
export function densify(points: readonly Xy[], spacing: number): [number, number][] {
  const dense: [number, number][] = [];
  points.forEach((p, i) => {
    const from = points[i - 1];
    const steps = from ? Math.max(1, Math.ceil(Math.hypot(p[0] - from[0], p[1] - from[1]) / spacing)) : 1;
    for (let k = 1; from && k < steps; k++) {
      dense.push([from[0] + ((p[0] - from[0]) * k) / steps, from[1] + ((p[1] - from[1]) * k) / steps]);
    }
    dense.push([p[0], p[1]]);
  });
  return dense;
}
