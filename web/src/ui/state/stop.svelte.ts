/** The emergency stop as the person sees it: pressed, confirmed, or, after half a second without an answer, NOT confirmed. */
export type StopState = 'idle' | 'sending' | 'unconfirmed' | 'confirmed' | 'refused';

const kMustAnswerMs = 500;
const kShowConfirmedMs = 1_500;

export class Stop {
  state = $state<StopState>('idle');
  readonly #engage: () => Promise<string>;
  readonly #after: (ms: number, run: () => void) => () => void;
  /** Answers that came before the id of their command was known, and ids still unanswered. */
  readonly #open = new Set<string>();
  readonly #early = new Map<string, boolean>();
  #cancel: () => void = () => {};

  constructor(engage: () => Promise<string>, after: (ms: number, run: () => void) => () => void) {
    this.#engage = engage;
    this.#after = after;
  }

  async press(): Promise<void> {
    this.state = 'sending';
    this.#cancel();
    this.#cancel = this.#after(kMustAnswerMs, () => {
      if (this.state === 'sending') this.state = 'unconfirmed';
    });
    const id = await this.#engage();
    const early = this.#early.get(id);
    this.#early.clear();
    if (early !== undefined) this.#settle(early);
    else this.#open.add(id);
  }

  answered(id: string, done: boolean): void {
    if (this.#open.delete(id)) this.#settle(done);
    else if (this.state === 'sending' || this.state === 'unconfirmed') this.#early.set(id, done);
  }

  dismiss(): void {
    this.#cancel();
    this.state = 'idle';
  }

  #settle(done: boolean): void {
    this.#cancel();
    this.state = done ? 'confirmed' : 'refused';
    if (done) this.#cancel = this.#after(kShowConfirmedMs, () => (this.state = 'idle'));
  }
}
