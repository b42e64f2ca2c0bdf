/** A Session with sockets in memory and a clock that is wound by hand. */
import { Api } from '../../src/link/api';
import { MemoryStorage, Outbox, type OutboxStorage } from '../../src/link/outbox';
import type { Restored } from '../../src/model/saved';
import { type Keeping, Session } from '../../src/ui/state/session.svelte';
import type { Role } from '../../src/wire/parts';
import { FakeSurroundings, settle } from './fake_surroundings';

export interface Opened {
  readonly session: Session;
  readonly around: FakeSurroundings;
  /** The server answers `hello`. */
  welcome(epoch?: number): Promise<void>;
  tell(message: object): Promise<void>;
  delta(part: string, set: Record<string, unknown>, options?: { rev?: number; reset?: boolean; del?: string[] }): Promise<void>;
  lose(): Promise<void>;
  commands(): Record<string, unknown>[];
  readonly log: string[];
}

/** Frames are painted at once. */
function withoutScreen(): void {
  Object.assign(globalThis, { document: { hidden: false }, requestAnimationFrame: (run: () => void) => queueMicrotask(run) });
}

interface Options {
  readonly role?: Role;
  readonly kept?: Restored;
  readonly keeping?: Keeping;
  readonly storage?: OutboxStorage;
  readonly fetcher?: typeof fetch;
}

export async function openSession({ role = 'commander', kept, keeping, storage = new MemoryStorage(), fetcher }: Options = {}): Promise<Opened> {
  withoutScreen();
  const around = new FakeSurroundings();
  const log: string[] = [];
  const outbox = await Outbox.open(storage);
  const me = { token: 'secret', device: 'd', name: 'Anna', role };
  const session = new Session(me, new Api(fetcher ?? (() => Promise.reject(new TypeError('no network')))), outbox, around, () => log.push('unauthorised'), kept, keeping);
  session.toasts.show = (tone, text) => void log.push(`${tone}: ${text}`);
  session.start();
  const tell = async (message: object): Promise<void> => {
    around.socket.say(message);
    for (let i = 0; i < 4; i++) await settle();
  };
  return {
    session,
    around,
    log,
    tell,
    welcome: async (epoch = 7) => {
      if (around.socket.closed || !around.socket.onopen) await around.pass(8_000);
      around.socket.onopen?.();
      await tell({ type: 'welcome', device: 'd', role, name: 'Anna', epoch, seq: 1, server_ms: around.now });
    },
    delta: (part, set, options = {}) => tell({ type: 'delta', part, rev: options.rev ?? 1, reset: options.reset ?? false, set, del: options.del ?? [] }),
    lose: async () => {
      around.socket.onclose?.(1006);
      await around.pass(8_000);
    },
    commands: () => around.sockets.flatMap((socket) => socket.of('command')),
  };
}
