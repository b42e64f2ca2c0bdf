const kTurn = 2 * Math.PI;

/** Wraps to [-pi, pi). */
export function wrapAngle(angle: number): number {
  const wrapped = (angle + Math.PI) % kTurn;
  return (wrapped < 0 ? wrapped + kTurn : wrapped) - Math.PI;
}

/** The nearest multiple of `step` if `angle` is within `tolerance` of it, else `angle` unchanged. Radians. */
export function snapAngle(angle: number, step: number, tolerance: number): number {
  const nearest = Math.round(angle / step) * step;
  return Math.abs(angle - nearest) <= tolerance ? nearest : angle;
}
