import { distance, type Xy } from './points';

/** How far along a-b (0..1) the point nearest to `p` lies. */
export function nearestParameter(p: Xy, a: Xy, b: Xy): number {
  const dx = b[0] - a[0];
  const dy = b[1] - a[1];
  const squared = dx * dx + dy * dy;
  if (squared === 0) return 0;
  const t = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared;
  return Math.min(1, Math.max(0, t));
}

export function nearestOnSegment<P extends Xy>(p: P, a: P, b: P): P {
  const t = nearestParameter(p, a, b);
  return [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])] as unknown as P;
}

export const distanceToSegment = (p: Xy, a: Xy, b: Xy): number => distance(p, nearestOnSegment(p, a, b));

/** Shortest distance from `p` to an open chain of points; infinite for an empty one. */
export function distanceToPolyline(p: Xy, points: readonly Xy[]): number {
  const first = points[0];
  if (!first) return Infinity;
  let best = distance(p, first);
  for (let i = 1; i < points.length; i++) {
    best = Math.min(best, distanceToSegment(p, points[i - 1]!, points[i]!));
  }
  return best;
}
