/** How the plan was fitted to what robots saw, in numbers for people: how much each part was stretched, how far each fixed point is off. */
import { mapToPlan, type PlanMesh, planToMap } from '../geometry/mesh';
import { distance, type LayoutPx, type MapPoint } from '../geometry/points';
import type { World } from './world';

export interface StretchedTriangle {
  readonly corners: readonly [MapPoint, MapPoint, MapPoint];
  /** Side length on the map over what one scale for all would give: 1.1 = ten percent longer. */
  readonly stretch: number;
}

const area = (a: readonly [number, number], b: readonly [number, number], c: readonly [number, number]): number =>
  Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;

/** @param metresPerPixel one scale for the whole plan; without it the plan's own mean. */
export function localStretch(mesh: PlanMesh, metresPerPixel: number | null): StretchedTriangle[] {
  const found: { corners: readonly [MapPoint, MapPoint, MapPoint]; px2: number; m2: number }[] = [];
  for (const [i, j, k] of mesh.triangles) {
    const [p, q, r] = [mesh.px[i], mesh.px[j], mesh.px[k]];
    const [a, b, c] = [mesh.map[i], mesh.map[j], mesh.map[k]];
    if (!p || !q || !r || !a || !b || !c) continue;
    const px2 = area(p, q, r);
    if (px2 > 0) found.push({ corners: [a, b, c], px2, m2: area(a, b, c) });
  }
  const sum = (of: 'px2' | 'm2'): number => found.reduce((total, triangle) => total + triangle[of], 0);
  const scale = metresPerPixel ?? Math.sqrt(sum('m2') / sum('px2'));
  return found.map(({ corners, px2, m2 }) => ({ corners, stretch: Math.sqrt(m2 / px2) / scale }));
}

export interface ShownAnchor {
  readonly id: string;
  /** Where a person says that this place of the plan is. */
  readonly at: MapPoint;
  /** Where the fitted plan shows it. */
  readonly shown: MapPoint | undefined;
  /** How far apart these are; undefined where the plan says nothing. */
  readonly residualM: number | undefined;
  /** Contradicts the other points: the plan does not follow it. */
  readonly outlier: boolean;
}

export function shownAnchors(world: World): ShownAnchor[] {
  const mesh = world.planMesh;
  return [...world.tables.anchors].map(([id, { px, map, off_m, outlier }]) => {
    const shown = mesh ? planToMap(mesh, px) : undefined;
    return { id, at: map, shown, residualM: off_m ?? (shown && distance(shown, map)), outlier };
  });
}

/** The place of the plan that the map shows at `p`; undefined beside the plan. */
export const planPlaceAt = (world: World, p: MapPoint): LayoutPx | undefined =>
  world.planMesh ? mapToPlan(world.planMesh, p) : undefined;
