/**
 * Commands that the server has not acknowledged, in order. Written to the disk of the tablet before they are sent, so a
 * dead battery or a closed tab loses nothing a person did; sent again after every reconnect, which is harmless because a
 * command's id makes it happen once.
 */
import type { Command } from '../wire/commands';

export interface Entry {
  readonly id: string;
  /** Order of making; grows within one device. */
  readonly order: number;
  readonly command: Command;
  readonly createdMs: number;
  /** Server clock after which it must not be carried out; null = whenever the link is back. */
  readonly expiresMs: number | null;
}

/** Where entries survive. `all` gives them in `order`. */
export interface OutboxStorage {
  all(): Promise<Entry[]>;
  put(entry: Entry): Promise<void>;
  remove(id: string): Promise<void>;
}

export class MemoryStorage implements OutboxStorage {
  readonly #entries = new Map<string, Entry>();
  all(): Promise<Entry[]> {
    return Promise.resolve([...this.#entries.values()].sort((a, b) => a.order - b.order));
  }
  put(entry: Entry): Promise<void> {
    this.#entries.set(entry.id, entry);
    return Promise.resolve();
  }
  remove(id: string): Promise<void> {
    this.#entries.delete(id);
    return Promise.resolve();
  }
}

export class Outbox {
  readonly #storage: OutboxStorage;
  readonly #entries = new Map<string, Entry>();
  #nextOrder = 1;

  private constructor(storage: OutboxStorage) {
    this.#storage = storage;
  }

  static async open(storage: OutboxStorage): Promise<Outbox> {
    const outbox = new Outbox(storage);
    for (const entry of await storage.all()) {
      outbox.#entries.set(entry.id, entry);
      outbox.#nextOrder = Math.max(outbox.#nextOrder, entry.order + 1);
    }
    return outbox;
  }

  get entries(): Entry[] {
    return [...this.#entries.values()].sort((a, b) => a.order - b.order);
  }

  /** Resolves when the command is on disk: only then may it be shown as kept. */
  async add(id: string, command: Command, createdMs: number, expiresMs: number | null): Promise<Entry> {
    const entry: Entry = { id, order: this.#nextOrder++, command, createdMs, expiresMs };
    this.#entries.set(id, entry);
    await this.#storage.put(entry);
    return entry;
  }

  get(id: string): Entry | undefined {
    return this.#entries.get(id);
  }

  /** The server answered. Unknown ids are fine: an answer may come twice. */
  async settle(id: string): Promise<Entry | undefined> {
    const entry = this.#entries.get(id);
    this.#entries.delete(id);
    await this.#storage.remove(id);
    return entry;
  }

  /** Entries whose time has passed; they are gone from the outbox afterwards and must be reported to the person. */
  async expire(serverNowMs: number): Promise<Entry[]> {
    const late = this.entries.filter((entry) => entry.expiresMs !== null && entry.expiresMs <= serverNowMs);
    for (const entry of late) await this.settle(entry.id);
    return late;
  }
}
