/** Words for what the status bar shows. A value that nobody measured has no word for good. */
import type { Goal, GoalState, Robot } from '../wire/parts';

export type LinkWord = 'live' | 'slow' | 'lost' | 'connecting';

/** By the age of the last frame of any kind: 3 s amber, 10 s red (docs/wire.md, "Heartbeat"). */
export const kSlowMs = 3_000;
export const kLostMs = 10_000;

export function linkWord(connected: boolean, ageMs: number | null): LinkWord {
  if (ageMs === null) return connected ? 'live' : 'connecting';
  if (ageMs >= kLostMs || !connected) return 'lost';
  return ageMs >= kSlowMs ? 'slow' : 'live';
}

export type Quality = 'good' | 'fair' | 'poor' | 'unknown';

/** How well a robot knows where it is; one standard deviation of its position. */
export function localisationQuality(robot: Robot): Quality {
  if (!robot.localized || robot.sigma_m === null) return 'unknown';
  return robot.sigma_m <= 0.15 ? 'good' : robot.sigma_m <= 0.5 ? 'fair' : 'poor';
}

const kFinal: ReadonlySet<GoalState> = new Set<GoalState>(['arrived', 'refused', 'cancelled', 'failed']);
export const isFinal = (state: GoalState): boolean => kFinal.has(state);

/** Open goals first, oldest first; then what ended, newest first. */
export function sortGoals(goals: ReadonlyMap<string, Goal>): (Goal & { readonly id: string })[] {
  return [...goals]
    .map(([id, goal]) => ({ ...goal, id }))
    .sort((a, b) => {
      const ended = Number(isFinal(a.state)) - Number(isFinal(b.state));
      if (ended !== 0) return ended;
      return isFinal(a.state) ? b.created_ms - a.created_ms : a.created_ms - b.created_ms;
    });
}

/** "0.4 s", "12 s", "3 min", "2 h": short, and never more exact than it matters. */
export function formatAge(ms: number): string {
  const seconds = Math.max(0, ms) / 1000;
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  if (seconds < 99.5) return `${Math.round(seconds)} s`;
  if (seconds < 99.5 * 60) return `${Math.round(seconds / 60)} min`;
  return `${Math.round(seconds / 3600)} h`;
}

export const formatMetres = (m: number): string => (m < 10 ? `${m.toFixed(m < 1 ? 2 : 1)} m` : `${Math.round(m)} m`);
