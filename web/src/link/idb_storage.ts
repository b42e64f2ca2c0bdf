import { type DBSchema, type IDBPDatabase, openDB } from 'idb';
import type { Entry, OutboxStorage } from './outbox';

interface Schema extends DBSchema {
  outbox: { key: string; value: Entry; indexes: { order: number } };
  state: { key: string; value: unknown };
}

/** What is kept beside the outbox: the last state that was seen, and a plan being prepared. */
export type StateName = 'last' | 'preparation';

/** Where states survive a reload; null where there is none. */
export interface StateStorage {
  loadState(name: StateName): Promise<unknown>;
  saveState(name: StateName, state: unknown): Promise<void>;
}

/** The outbox and the kept states in IndexedDB. One database per paired device: two people on one tablet do not act for each other. */
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

  async loadState(name: StateName): Promise<unknown> {
    return (await this.#db.get('state', name)) ?? null;
  }
  async saveState(name: StateName, state: unknown): Promise<void> {
    await this.#db.put('state', state, name);
  }
  async forgetStates(): Promise<void> {
    await this.#db.clear('state');
  }
}
