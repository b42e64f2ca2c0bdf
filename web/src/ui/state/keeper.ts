/** Writes the last state to the disk: soon after the first change, then now and then, and at once when the page goes out of sight. */
import type { StateStorage } from '../../link/idb_storage';

const kFirstMs = 2_000;
/** The world as the server shows it follows its answer within this time. */
const kActedMs = 1_000;
const kEveryMs = 20_000;

export class Keeper {
  readonly #storage: StateStorage;
  readonly #after: (ms: number, run: () => void) => () => void;
  #state: () => unknown = () => undefined;
  #cancel: (() => void) | undefined;
  #wait = kFirstMs;

  constructor(storage: StateStorage, after: (ms: number, run: () => void) => () => void) {
    this.#storage = storage;
    this.#after = after;
  }

  /** @param state what to write; undefined when there is nothing worth keeping. */
  watch(state: () => unknown): void {
    this.#state = state;
  }

  changed(): void {
    this.#cancel ??= this.#after(this.#wait, () => void this.flush());
  }
  /** Something that a person did is part of the state now. */
  acted(): void {
    this.#cancel?.();
    this.#cancel = this.#after(kActedMs, () => void this.flush());
  }

  /** A disk that is full or forbidden costs the last state, nothing else. */
  async flush(): Promise<void> {
    this.#cancel?.();
    this.#cancel = undefined;
    this.#wait = kEveryMs;
    const state = this.#state();
    if (state !== undefined) await this.#storage.saveState('last', state).catch(() => undefined);
  }
}
