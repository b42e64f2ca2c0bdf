import type { Xy } from './points';

/** An upright box. Empty until something was added. */
export interface Bounds {
  readonly minX: number;
  readonly minY: number;
  readonly maxX: number;
  readonly maxY: number;
}

export const kNoBounds: Bounds = { minX: Infinity, minY: Infinity, maxX: -Infinity, maxY: -Infinity };

export function extend(bounds: Bounds, p: Xy): Bounds {
  return {
    minX: Math.min(bounds.minX, p[0]),
    minY: Math.min(bounds.minY, p[1]),
    maxX: Math.max(bounds.maxX, p[0]),
    maxY: Math.max(bounds.maxY, p[1]),
  };
}

export const boundsOf = (points: Iterable<Xy>): Bounds => {
  let bounds = kNoBounds;
  for (const p of points) bounds = extend(bounds, p);
  return bounds;
};

export const isEmpty = (b: Bounds): boolean => !(b.maxX >= b.minX && b.maxY >= b.minY);
