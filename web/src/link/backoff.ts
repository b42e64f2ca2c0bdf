/** Jittered back-off, 0.5 to 8 s: many tablets that lost one access point must not all come back in the same instant. */
const kFirstMs = 500;
const kLongestMs = 8_000;

/** @param attempt 0 for the first retry. @param random in [0, 1). */
export function backoffMs(attempt: number, random: number): number {
  const ceiling = Math.min(kLongestMs, kFirstMs * 2 ** Math.min(attempt, 10));
  return Math.max(kFirstMs, ceiling * (0.5 + random / 2));
}
