import { type DBSchema, type IDBPDatabase, openDB } from 'idb';
import type { Entry, OutboxStorage } from './outbox';

interface Schema extends DBSchema {
  outbox: { key: string; value: Entry; indexes: { order: number } };
}

/** The outbox in IndexedDB. One database per paired device, so that two people on one tablet do not send for each other. */
export class IdbStorage implements OutboxStorage {
  readonly #db: IDBPDatabase<Schema>;

  private constructor(db: IDBPDatabase<Schema>) {
    this.#db = db;
  }

  static async open(device: string): Promise<IdbStorage> {
    const db = await openDB<Schema>(`smokemap-${device}`, 1, {
      upgrade: (fresh) => {
        fresh.createObjectStore('outbox', { keyPath: 'id' }).createIndex('order', 'order');
      },
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
}
