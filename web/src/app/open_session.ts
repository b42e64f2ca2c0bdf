import { Api } from '../link/api';
import { browserSurroundings } from '../link/browser';
import { IdbStorage } from '../link/idb_storage';
import { MemoryStorage, Outbox } from '../link/outbox';
import { type Restored, restoreState } from '../model/saved';
import type { Shared } from '../ui/context';
import { Keeper } from '../ui/state/keeper';
import { Pictures } from '../ui/state/pictures';
import { type Identity, Session } from '../ui/state/session.svelte';
import { parsePairing } from '../wire/http';

const kStored = 'smokemap.identity';

export function storedIdentity(): Identity | undefined {
  try {
    return parsePairing(JSON.parse(localStorage.getItem(kStored) ?? 'null'));
  } catch {
    return undefined;
  }
}

/** The device was turned away: nobody who finds it shall see the building. */
export function forgetIdentity(): void {
  const known = storedIdentity();
  localStorage.removeItem(kStored);
  if (known) void IdbStorage.open(known.device).then((storage) => storage.forgetStates(), () => undefined);
  void globalThis.caches?.delete('smokemap-pictures');
}

export async function openSession(me: Identity, onUnauthorised: () => void): Promise<Shared> {
  localStorage.setItem(kStored, JSON.stringify(me));
  const api = new Api();
  api.token = me.token;
  // Private windows may have no database: then commands live as long as the page.
  const storage = await IdbStorage.open(me.device).catch(() => undefined);
  const outbox = await Outbox.open(storage ?? new MemoryStorage());
  const kept: Restored | undefined = restoreState(await storage?.loadState('last').catch(() => null));
  const keeper = storage && new Keeper(storage, browserSurroundings.after);
  const turnedAway = (): void => {
    keeper?.watch(() => undefined);
    onUnauthorised();
  };
  const session = new Session(me, api, outbox, browserSurroundings, turnedAway, kept, keeper);
  keeper?.watch(() => session.state);
  window.addEventListener('online', () => session.link.hurry());
  document.addEventListener('visibilitychange', () => {
    if (document.hidden) void keeper?.flush();
    else session.link.hurry();
  });
  void navigator.storage?.persist?.();
  session.start();
  const pictures = new Pictures(api);
  const shelf = {
    load: async () => (await storage?.loadState('preparation')) ?? null,
    save: async (value: unknown) => storage?.saveState('preparation', value),
  };
  return { session, pictures, shelf };
}
