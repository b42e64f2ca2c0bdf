import { distance, type Xy } from './points';
import { nearestOnSegment } from './segment';

/** Where a pen near drawn walls is taken to be: a corner first, then a wall, then in line with the point it comes from. */
export interface Snapped<P extends Xy> {
  readonly p: P;
  readonly to: 'corner' | 'wall' | 'axis' | 'nothing';
}

export function snapToWalls<P extends Xy>(
  p: P,
  walls: readonly (readonly [P, P])[],
  reach: number,
  from?: P,
): Snapped<P> {
  let corner: P | undefined;
  let onWall: P | undefined;
  for (const [a, b] of walls) {
    for (const end of [a, b]) {
      if (distance(p, end) <= (corner ? distance(p, corner) : reach)) corner = end;
    }
    const foot = nearestOnSegment(p, a, b);
    if (distance(p, foot) <= (onWall ? distance(p, onWall) : reach)) onWall = foot;
  }
  if (corner) return { p: corner, to: 'corner' };
  if (onWall) return { p: onWall, to: 'wall' };
  if (from && Math.abs(p[0] - from[0]) <= reach) return { p: [from[0], p[1]] as unknown as P, to: 'axis' };
  if (from && Math.abs(p[1] - from[1]) <= reach) return { p: [p[0], from[1]] as unknown as P, to: 'axis' };
  return { p, to: 'nothing' };
}
