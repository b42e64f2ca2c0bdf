import type { Xy } from './points';

/** Even-odd rule; points on the border may count either way. */
export function contains(outline: readonly Xy[], p: Xy): boolean {
  let inside = false;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const [xi, yi] = outline[i]!;
    const [xj, yj] = outline[j]!;
    if (yi > p[1] !== yj > p[1] && p[0] < ((xj - xi) * (p[1] - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

/** Twice the signed area is the sum of cross products; positive when counter-clockwise with y up. */
export function signedArea(outline: readonly Xy[]): number {
  let sum = 0;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    sum += outline[j]![0] * outline[i]![1] - outline[i]![0] * outline[j]![1];
  }
  return sum / 2;
}

/** Centre of mass; the mean of the points when the area is nothing. */
export function centroid<P extends Xy>(outline: readonly P[]): P {
  const area = signedArea(outline);
  let x = 0;
  let y = 0;
  if (Math.abs(area) < 1e-9) {
    for (const p of outline) {
      x += p[0] / outline.length;
      y += p[1] / outline.length;
    }
    return [x, y] as unknown as P;
  }
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const cross = outline[j]![0] * outline[i]![1] - outline[i]![0] * outline[j]![1];
    x += (outline[j]![0] + outline[i]![0]) * cross;
    y += (outline[j]![1] + outline[i]![1]) * cross;
  }
  return [x / (6 * area), y / (6 * area)] as unknown as P;
}

/** A point inside: the centroid where it is, else the middle of the widest stretch at its height. */
export function interiorPoint<P extends Xy>(outline: readonly P[]): P {
  const middle = centroid(outline);
  if (contains(outline, middle)) return middle;
  const crossings: number[] = [];
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const [a, b] = [outline[i]!, outline[j]!];
    if (a[1] > middle[1] !== b[1] > middle[1]) crossings.push(a[0] + ((middle[1] - a[1]) / (b[1] - a[1])) * (b[0] - a[0]));
  }
  crossings.sort((x, y) => x - y);
  let widest = -1;
  let at = middle[0];
  for (let i = 0; i + 1 < crossings.length; i += 2) {
    const [left, right] = [crossings[i]!, crossings[i + 1]!];
    if (right - left > widest) [widest, at] = [right - left, (left + right) / 2];
  }
  return [at, middle[1]] as unknown as P;
}
