import { Api } from '../link/api';
import { browserSurroundings } from '../link/browser';
import { IdbStorage } from '../link/idb_storage';
import { MemoryStorage, Outbox, type OutboxStorage } from '../link/outbox';
import type { Shared } from '../ui/context';
import { Pictures } from '../ui/state/pictures';
import { Prepare } from '../ui/state/prepare.svelte';
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

export const forgetIdentity = (): void => localStorage.removeItem(kStored);

/** Private windows may have no database: then commands live as long as the page. */
async function openStorage(device: string): Promise<OutboxStorage> {
  return IdbStorage.open(device).catch(() => new MemoryStorage());
}

export async function openSession(me: Identity, onUnauthorised: () => void): Promise<Shared> {
  localStorage.setItem(kStored, JSON.stringify(me));
  const api = new Api();
  api.token = me.token;
  const outbox = await Outbox.open(await openStorage(me.device));
  const session = new Session(me, api, outbox, browserSurroundings, onUnauthorised);
  window.addEventListener('online', () => session.link.hurry());
  document.addEventListener('visibilitychange', () => {
    if (!document.hidden) session.link.hurry();
  });
  void navigator.storage?.persist?.();
  session.start();
  const pictures = new Pictures(api);
  return { session, pictures, prepare: new Prepare(session, pictures) };
}
