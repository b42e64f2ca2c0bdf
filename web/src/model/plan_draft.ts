/**
 * A read plan on its way to becoming the plan of the floor: walls can be switched off and on, drawn, and the scale set.
 * Immutable; every edit is a new draft, so undo is a list of drafts.
 */
import { distance, type LayoutPx } from '../geometry/points';
import { distanceToSegment } from '../geometry/segment';
import type { LayoutDocument } from '../wire/layout_document';

export interface DraftWall {
  readonly a: LayoutPx;
  readonly b: LayoutPx;
  readonly thickness: number;
  readonly confidence: number;
  readonly on: boolean;
  readonly byPerson: boolean;
}

export interface PlanDraft {
  readonly planId: string;
  readonly rectified: string;
  readonly document: LayoutDocument;
  readonly walls: readonly DraftWall[];
  readonly metresPerPixel: number | null;
  /** The scale was measured by a person, not guessed from doors. */
  readonly scaleByPerson: boolean;
}

/** Below this a wall is drawn dashed: a person should look at it. */
export const kDoubtful = 0.5;
const kSameCornerPx = 0.5;
/** One standard deviation of a length that somebody measured on a plan, relative. */
const kPersonScaleSigma = 0.03;

export function draftFrom(planId: string, rectified: string, document: LayoutDocument): PlanDraft {
  const walls = document.walls.map(([x1, y1, x2, y2, thickness], i): DraftWall => ({
    a: [x1, y1],
    b: [x2, y2],
    thickness,
    confidence: document.wall_confidence[i] ?? 1,
    on: true,
    byPerson: document.wall_by_person[i] ?? false,
  }));
  return { planId, rectified, document, walls, metresPerPixel: document.metres_per_pixel ?? null, scaleByPerson: document.scale_by_person };
}

export const wallAt = (draft: PlanDraft, p: LayoutPx, reach: number): number | undefined => {
  let best: number | undefined;
  let nearest = reach;
  draft.walls.forEach((wall, i) => {
    const off = distanceToSegment(p, wall.a, wall.b);
    if (off <= nearest) [best, nearest] = [i, off];
  });
  return best;
};

export const toggleWall = (draft: PlanDraft, index: number): PlanDraft => ({
  ...draft,
  walls: draft.walls.map((wall, i) => (i === index ? { ...wall, on: !wall.on, byPerson: true } : wall)),
});

export function addWall(draft: PlanDraft, a: LayoutPx, b: LayoutPx): PlanDraft {
  const thicknesses = draft.walls.map((wall) => wall.thickness).sort((x, y) => x - y);
  const thickness = thicknesses[thicknesses.length >> 1] ?? 4;
  return { ...draft, walls: [...draft.walls, { a, b, thickness, confidence: 1, on: true, byPerson: true }] };
}

/** undefined when the two points or the length say nothing. */
export function withScale(draft: PlanDraft, a: LayoutPx, b: LayoutPx, metres: number): PlanDraft | undefined {
  const pixels = distance(a, b);
  if (!(pixels > 1) || !(metres > 0) || !Number.isFinite(metres)) return undefined;
  return { ...draft, metresPerPixel: metres / pixels, scaleByPerson: true };
}

export const countWalls = (draft: PlanDraft): { on: number; doubtful: number; off: number } => ({
  on: draft.walls.filter((wall) => wall.on).length,
  doubtful: draft.walls.filter((wall) => wall.on && !wall.byPerson && wall.confidence < kDoubtful).length,
  off: draft.walls.filter((wall) => !wall.on).length,
});

/** The document to send: walls that are on, with the corners they use and no others. */
export function documentOf(draft: PlanDraft): LayoutDocument {
  const corners: LayoutPx[] = [];
  const cornerAt = (p: LayoutPx): number => {
    const known = corners.findIndex((corner) => distance(corner, p) <= kSameCornerPx);
    return known >= 0 ? known : corners.push(p) - 1;
  };
  const kept = draft.walls.filter((wall) => wall.on);
  return {
    ...draft.document,
    walls: kept.map(({ a, b, thickness }) => [a[0], a[1], b[0], b[1], thickness] as const),
    wall_confidence: kept.map((wall) => (wall.byPerson ? 1 : wall.confidence)),
    wall_by_person: kept.map((wall) => wall.byPerson),
    wall_corners: kept.map(({ a, b }) => [cornerAt(a), cornerAt(b)] as const),
    corners,
    corner_confidence: corners.map(() => 1),
    rectified: draft.rectified,
    metres_per_pixel: draft.metresPerPixel,
    scale_by_person: draft.scaleByPerson,
    scale_sigma: draft.scaleByPerson ? kPersonScaleSigma : (draft.document.scale_sigma ?? null),
  };
}
