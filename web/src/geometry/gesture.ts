/**
 * One or two fingers move, scale and turn a view: whatever lay under a finger when the gesture began stays under it.
 * A pure function of where the gesture began and where the fingers are now, so nothing drifts.
 */
import { snapAngle, wrapAngle } from './angle';
import { distance, headingFrom, midpoint, screenPoint, type ScreenPoint, type ViewPoint, viewPoint } from './points';
import { type Size, toScreen, toView, type ViewState } from './similarity';

export interface Limits {
  readonly minResolution: number;
  readonly maxResolution: number;
}

export interface Grip {
  readonly view: ViewState;
  readonly fingers: readonly ScreenPoint[];
}

const kQuarterTurn = Math.PI / 2;
const kSnapTolerance = (7 * Math.PI) / 180;
/** Fingers must turn by this much before the picture turns: a plain pinch must not tilt the map. */
const kTurnThreshold = (12 * Math.PI) / 180;

const clamp = (value: number, low: number, high: number): number => Math.min(high, Math.max(low, value));

/** The view in which the world point at `anchor` of `before` appears at `now`. */
function withAnchor(before: ViewState, anchor: ScreenPoint, now: ScreenPoint, resolution: number, rotation: number, size: Size): ViewState {
  const held = toView(before, size, anchor);
  const turned: ViewState = { center: before.center, resolution, rotation };
  const under = toView(turned, size, now);
  const center = viewPoint(before.center[0] + held[0] - under[0], before.center[1] + held[1] - under[1]);
  return { center, resolution, rotation };
}

export function moveView(grip: Grip, fingers: readonly ScreenPoint[], size: Size, limits: Limits): ViewState {
  const [a0, b0] = grip.fingers;
  const [a1, b1] = fingers;
  if (!a0 || !a1) return grip.view;
  if (!b0 || !b1) return withAnchor(grip.view, a0, a1, grip.view.resolution, grip.view.rotation, size);
  const spread = Math.max(distance(a0, b0), 1) / Math.max(distance(a1, b1), 1);
  const resolution = clamp(grip.view.resolution * spread, limits.minResolution, limits.maxResolution);
  const turn = wrapAngle(headingFrom(a1, b1) - headingFrom(a0, b0));
  const eased = Math.abs(turn) < kTurnThreshold ? 0 : turn - Math.sign(turn) * kTurnThreshold;
  const rotation = snapAngle(grip.view.rotation + eased, kQuarterTurn, kSnapTolerance);
  return withAnchor(grip.view, midpoint(a0, b0), midpoint(a1, b1), resolution, rotation, size);
}

/** `factor` > 1 comes closer. The point under `at` stays where it is. */
export function zoomAbout(view: ViewState, at: ScreenPoint, factor: number, size: Size, limits: Limits): ViewState {
  const resolution = clamp(view.resolution / factor, limits.minResolution, limits.maxResolution);
  return withAnchor(view, at, at, resolution, view.rotation, size);
}

/** Part of the screen, CSS pixels. */
export interface Box {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** The view moved up just so far that `p` is `margin` above a card that covers it; the same view where none does, or no room is left above. */
export function uncovered(view: ViewState, size: Size, p: ViewPoint, card: Box, margin: number): ViewState {
  const at = toScreen(view, size, p);
  const isCovered = at[0] > card.left - margin && at[0] < card.right + margin && at[1] > card.top - margin && at[1] < card.bottom;
  const free = card.top - margin;
  if (!isCovered || free < margin) return view;
  return withAnchor(view, at, screenPoint(at[0], free), view.resolution, view.rotation, size);
}

export const middle = (size: Size): ScreenPoint => screenPoint(size.width / 2, size.height / 2);
