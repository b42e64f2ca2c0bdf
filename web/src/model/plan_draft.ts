/**
 * A read plan on its way to becoming the plan of the floor: walls can be switched off and on, drawn, gaps told apart, and
 * the scale set.
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

export type OpeningKind = 'door' | 'window' | 'passage';

/** A gap between walls. */
export interface Opening {
  readonly a: LayoutPx;
  readonly b: LayoutPx;
  readonly kind: OpeningKind;
  readonly confidence: number;
}

export interface PlanDraft {
  readonly planId: string;
  readonly rectified: string;
  readonly document: LayoutDocument;
  readonly walls: readonly DraftWall[];
  readonly openings: readonly Opening[];
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
  const openings = document.doors.map(([x1, y1, x2, y2], i): Opening => ({
    a: [x1, y1],
    b: [x2, y2],
    kind: document.door_kinds[i] ?? 'door',
    confidence: document.door_confidence[i] ?? 1,
  }));
  const metresPerPixel = document.metres_per_pixel ?? null;
  return { planId, rectified, document, walls, openings, metresPerPixel, scaleByPerson: document.scale_by_person };
}

export interface Box {
  readonly low: LayoutPx;
  readonly high: LayoutPx;
}

/** Other drawings on the sheet, any of which could be the floor that is meant. */
export const otherDrawings = ({ document }: PlanDraft): readonly Box[] =>
  document.drawings
    .filter(({ chosen }) => !chosen)
    .map(({ box: [x1, y1, x2, y2] }) => ({ low: [x1, y1], high: [x2, y2] }));

/** The smallest of the other drawings under the finger. */
export function drawingAt(draft: PlanDraft, [x, y]: LayoutPx): Box | undefined {
  const size = ({ low, high }: Box): number => (high[0] - low[0]) * (high[1] - low[1]);
  return otherDrawings(draft)
    .filter(({ low, high }) => x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1])
    .sort((a, b) => size(a) - size(b))[0];
}

/** The picture was read after its corners were given, not as it was taken. */
export const isRectified = ({ document }: PlanDraft): boolean =>
  document.homography?.some((value, i) => Math.abs(value - (i % 4 === 0 ? 1 : 0)) > 1e-9) ?? false;

function nearestLine(lines: readonly { readonly a: LayoutPx; readonly b: LayoutPx }[], p: LayoutPx, reach: number): number | undefined {
  let best: number | undefined;
  let nearest = reach;
  lines.forEach(({ a, b }, i) => {
    const off = distanceToSegment(p, a, b);
    if (off <= nearest) [best, nearest] = [i, off];
  });
  return best;
}

export const wallAt = (draft: PlanDraft, p: LayoutPx, reach: number): number | undefined => nearestLine(draft.walls, p, reach);

/** A gap lies between the ends of walls: a finger on its middle half means the gap, nearer to its ends a wall. */
export function openingAt(draft: PlanDraft, p: LayoutPx, reach: number): number | undefined {
  const middles = draft.openings.map(({ a, b }) => ({ a: between(a, b, 0.25), b: between(a, b, 0.75) }));
  return nearestLine(middles, p, reach);
}

const between = (a: LayoutPx, b: LayoutPx, share: number): LayoutPx => [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];

/** A person says what the gap is; what a person said is sure. */
export const nameOpening = (draft: PlanDraft, index: number, kind: OpeningKind): PlanDraft => ({
  ...draft,
  openings: draft.openings.map((opening, i) => (i === index ? { ...opening, kind, confidence: 1 } : opening)),
});

/** No gap at all: the wall goes through. */
export function closeOpening(draft: PlanDraft, index: number): PlanDraft {
  const opening = draft.openings[index];
  if (!opening) return draft;
  return { ...addWall(draft, opening.a, opening.b), openings: draft.openings.filter((_, i) => i !== index) };
}

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
    doors: draft.openings.map(({ a, b }) => [a[0], a[1], b[0], b[1]] as const),
    door_kinds: draft.openings.map(({ kind }) => kind),
    door_confidence: draft.openings.map(({ confidence }) => confidence),
    corners,
    corner_confidence: corners.map(() => 1),
    rectified: draft.rectified,
    metres_per_pixel: draft.metresPerPixel,
    scale_by_person: draft.scaleByPerson,
    scale_sigma: draft.scaleByPerson ? kPersonScaleSigma : (draft.document.scale_sigma ?? null),
  };
}
