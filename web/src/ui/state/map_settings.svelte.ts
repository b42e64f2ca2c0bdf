import type { WallState } from '../../wire/parts';

export type Versions = 'after' | 'before' | 'both';

/** What of the map is shown; one per mode, so that a look at the past does not change the live view. */
export class MapSettings {
  sensed = $state(1);
  picture = $state(0);
  /** How the plan was fitted: local scale and links. */
  fit = $state(false);
  versions = $state<Versions>('after');
  hidden = $state.raw<ReadonlySet<WallState>>(new Set());

  toggle(state: WallState): void {
    const next = new Set(this.hidden);
    if (!next.delete(state)) next.add(state);
    this.hidden = next;
  }
}
