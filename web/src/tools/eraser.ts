import type { Xy } from '../geometry/points';
import { distanceToPolyline } from '../geometry/segment';

/** Strokes that the eraser's path touches: whole strokes, because a stroke is what a person undoes. */
export function touchedStrokes(
  path: readonly Xy[],
  strokes: ReadonlyMap<string, { readonly points: readonly Xy[]; readonly width: number }>,
  reach: number,
): Set<string> {
  const touched = new Set<string>();
  for (const [id, { points, width }] of strokes) {
    if (path.some((p) => distanceToPolyline(p, points) <= reach + width / 2)) touched.add(id);
  }
  return touched;
}
