import { screenPoint, viewPoint, type ScreenPoint, type ViewPoint, type Xy } from './points';

/** How a canvas looks at its world, with OpenLayers' meanings and signs. */
export interface ViewState {
  readonly center: ViewPoint;
  /** World units per CSS pixel. */
  readonly resolution: number;
  /** Radians; positive turns what is seen clockwise. */
  readonly rotation: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** World -> screen as the six numbers of a canvas transform: x = a X + c Y + e, y = b X + d Y + f. */
export type Affine = readonly [a: number, b: number, c: number, d: number, e: number, f: number];

export function viewToScreenAffine(view: ViewState, size: Size): Affine {
  const scale = 1 / view.resolution;
  const cos = Math.cos(view.rotation) * scale;
  const sin = Math.sin(view.rotation) * scale;
  const [cx, cy] = view.center;
  // Flip y, turn clockwise by the rotation, scale, move the centre to the middle of the canvas.
  return [cos, sin, sin, -cos, size.width / 2 - cos * cx - sin * cy, size.height / 2 - sin * cx + cos * cy];
}

export const applyAffine = (m: Affine, p: Xy): readonly [number, number] => [
  m[0] * p[0] + m[2] * p[1] + m[4],
  m[1] * p[0] + m[3] * p[1] + m[5],
];

export function invertAffine(m: Affine): Affine {
  const determinant = m[0] * m[3] - m[1] * m[2];
  const a = m[3] / determinant;
  const b = -m[1] / determinant;
  const c = -m[2] / determinant;
  const d = m[0] / determinant;
  return [a, b, c, d, -(a * m[4] + c * m[5]), -(b * m[4] + d * m[5])];
}

export function toScreen(view: ViewState, size: Size, p: ViewPoint): ScreenPoint {
  const [x, y] = applyAffine(viewToScreenAffine(view, size), p);
  return screenPoint(x, y);
}

export function toView(view: ViewState, size: Size, p: ScreenPoint): ViewPoint {
  const [x, y] = applyAffine(invertAffine(viewToScreenAffine(view, size)), p);
  return viewPoint(x, y);
}

/**
 * The shift, turn and scale that takes `from` closest to `to` (least squares), as canvas numbers. With `mirrored` the
 * source has y down and the target y up. undefined for fewer than two distinct points.
 */
export function fitSimilarity(from: readonly Xy[], to: readonly Xy[], mirrored: boolean): Affine | undefined {
  const n = Math.min(from.length, to.length);
  const flip = mirrored ? -1 : 1;
  const mean = (points: readonly Xy[], axis: 0 | 1): number =>
    points.slice(0, n).reduce((sum, p) => sum + p[axis], 0) / n;
  const [fx, fy, tx, ty] = [mean(from, 0), mean(from, 1), mean(to, 0), mean(to, 1)];
  let squared = 0;
  let along = 0;
  let across = 0;
  for (let i = 0; i < n; i++) {
    const x = from[i]![0] - fx;
    const y = flip * (from[i]![1] - fy);
    const u = to[i]![0] - tx;
    const w = to[i]![1] - ty;
    squared += x * x + y * y;
    along += x * u + y * w;
    across += x * w - y * u;
  }
  if (!(squared > 0)) return undefined;
  const cos = along / squared;
  const sin = across / squared;
  return [cos, sin, -flip * sin, flip * cos, tx - cos * fx + flip * sin * fy, ty - sin * fx - flip * cos * fy];
}
