/**
 * The plan as it lies in the map now: triangles with corners in both frames. Inside a triangle the answer is affine, so
 * it is exact at the corners and continuous across edges. Outside there is no answer.
 */
import { layoutPx, mapPoint, type LayoutPx, type MapPoint, type Xy } from './points';
import type { Affine } from './similarity';

export interface PlanMesh {
  readonly px: readonly LayoutPx[];
  readonly map: readonly MapPoint[];
  readonly triangles: readonly (readonly [number, number, number])[];
}

type Triangle = readonly [Xy, Xy, Xy];

/** Weights of the three corners at `p`; undefined for a triangle without area. */
function barycentric(p: Xy, [a, b, c]: Triangle): readonly [number, number, number] | undefined {
  const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (Math.abs(area) < 1e-12) return undefined;
  const v = ((p[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (p[1] - a[1])) / area;
  const w = ((b[0] - a[0]) * (p[1] - a[1]) - (p[0] - a[0]) * (b[1] - a[1])) / area;
  return [1 - v - w, v, w];
}

const pick = <P extends Xy>(points: readonly P[], [i, j, k]: readonly [number, number, number]): Triangle | undefined => {
  const a = points[i];
  const b = points[j];
  const c = points[k];
  return a && b && c ? [a, b, c] : undefined;
};

function carry(p: Xy, mesh: PlanMesh, from: readonly Xy[], to: readonly Xy[]): Xy | undefined {
  const kOnEdge = -1e-9;
  for (const triangle of mesh.triangles) {
    const source = pick(from, triangle);
    const target = pick(to, triangle);
    const weights = source && barycentric(p, source);
    if (!weights || !target || Math.min(...weights) < kOnEdge) continue;
    const mix = (axis: 0 | 1): number => weights.reduce((sum, w, i) => sum + w * target[i]![axis], 0);
    return [mix(0), mix(1)];
  }
  return undefined;
}

export function planToMap(mesh: PlanMesh, p: LayoutPx): MapPoint | undefined {
  const found = carry(p, mesh, mesh.px, mesh.map);
  return found && mapPoint(found[0], found[1]);
}

export function mapToPlan(mesh: PlanMesh, p: MapPoint): LayoutPx | undefined {
  const found = carry(p, mesh, mesh.map, mesh.px);
  return found && layoutPx(found[0], found[1]);
}

/** The affine that takes triangle `from` to triangle `to`, as canvas numbers; undefined for a triangle without area. */
export function triangleAffine(from: Triangle, to: Triangle): Affine | undefined {
  const [a, b, c] = from;
  const determinant = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (Math.abs(determinant) < 1e-12) return undefined;
  const column = (axis: 0 | 1): readonly [number, number, number] => {
    const db = to[1][axis] - to[0][axis];
    const dc = to[2][axis] - to[0][axis];
    const along = (db * (c[1] - a[1]) - dc * (b[1] - a[1])) / determinant;
    const up = (dc * (b[0] - a[0]) - db * (c[0] - a[0])) / determinant;
    return [along, up, to[0][axis] - along * a[0] - up * a[1]];
  };
  const x = column(0);
  const y = column(1);
  return [x[0], y[0], x[1], y[1], x[2], y[2]];
}
