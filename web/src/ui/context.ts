import { getContext, setContext } from 'svelte';
import type { Pictures } from './state/pictures';
import type { Prepare } from './state/prepare.svelte';
import type { Session } from './state/session.svelte';

const kSession = Symbol('session');

export interface Shared {
  readonly session: Session;
  readonly pictures: Pictures;
  /** Survives a change of mode: a half-prepared plan is not lost by a look at the map. */
  readonly prepare: Prepare;
}

export const provide = (shared: Shared): Shared => setContext(kSession, shared);
export const useShared = (): Shared => getContext<Shared>(kSession);
export const useSession = (): Session => useShared().session;
