/** What lies under a finger. Distances are on the screen, so that glove-sized means the same at every zoom. */
import { distance, type ScreenPoint, type ViewPoint } from '../geometry/points';

export interface Target<T> {
  readonly p: ViewPoint;
  readonly what: T;
}

export const kHitRadiusPx = 48;

/** Every target within reach, nearest first: a chooser opens when there are several. */
export function hits<T>(at: ScreenPoint, targets: readonly Target<T>[], toScreen: (p: ViewPoint) => ScreenPoint, reach = kHitRadiusPx): T[] {
  return targets
    .map(({ p, what }) => ({ what, off: distance(toScreen(p), at) }))
    .filter(({ off }) => off <= reach)
    .sort((a, b) => a.off - b.off)
    .map(({ what }) => what);
}

export const nearest = <T>(at: ScreenPoint, targets: readonly Target<T>[], toScreen: (p: ViewPoint) => ScreenPoint, reach = kHitRadiusPx): T | undefined =>
  hits(at, targets, toScreen, reach)[0];
