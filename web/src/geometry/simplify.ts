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
