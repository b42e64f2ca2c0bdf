import { type DBSchema, type IDBPDatabase, openDB } from 'idb';
import type { Entry, OutboxStorage } from './outbox';

interface Schema extends DBSchema {
  outbox: { key: string; value: Entry; indexes: { order: number } };
  state: { key: string; value: unknown };
}

const kLast = 'last';

/** Where the last state survives; null when there is none. */
export interface StateStorage {
  loadState(): Promise<unknown>;
  saveState(state: unknown): Promise<void>;
}

/** The outbox and the last state in IndexedDB. One database per paired device: two people on one tablet do not act for each other. */
export class IdbStorage implements OutboxStorage, StateStorage {
  readonly #db: IDBPDatabase<Schema>;

  private constructor(db: IDBPDatabase<Schema>) {
    this.#db = db;
  }

  static async open(device: string): Promise<IdbStorage> {
    const db = await openDB<Schema>(`smokemap-${device}`, 2, {
      upgrade: (fresh, from) => {
        if (from < 1) fresh.createObjectStore('outbox', { keyPath: 'id' }).createIndex('order', 'order');
        if (from < 2) fresh.createObjectStore('state');
      },
      // A newer page in another tab wants to change the form of the database: it must not wait for this one.
      blocking: (_, __, event) => (event.target as IDBDatabase).close(),
    });
    return new IdbStorage(db);
  }

  all(): Promise<Entry[]> {
    return this.#db.getAllFromIndex('outbox', 'order');
  }
  async put(entry: Entry): Promise<void> {
    await this.#db.put('outbox', entry);
  }
  async remove(id: string): Promise<void> {
    await this.#db.delete('outbox', id);
  }

  async loadState(): Promise<unknown> {
    return (await this.#db.get('state', kLast)) ?? null;
  }
  async saveState(state: unknown): Promise<void> {
    await this.#db.put('state', state, kLast);
  }
}
