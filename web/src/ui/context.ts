import { getContext, setContext } from 'svelte';
import type { Pictures } from './state/pictures';
import type { Prepare, Shelf } from './state/prepare.svelte';
import type { Session } from './state/session.svelte';

const kSession = Symbol('session');

export interface Shared {
  readonly session: Session;
  readonly pictures: Pictures;
  /** Where a half-prepared plan is kept. */
  readonly shelf: Shelf;
  /** Made when somebody first prepares; survives a change of mode, so a look at the map loses nothing. */
  prepare?: Prepare;
}

/** For pages that are rendered without the shell. */
export const contextOf = (shared: Shared): Map<unknown, unknown> => new Map([[kSession, shared]]);

export const provide = (shared: Shared): Shared => setContext(kSession, shared);
export const useShared = (): Shared => getContext<Shared>(kSession);
export const useSession = (): Session => useShared().session;
