/** Sends the live end of a stroke to the others, at most ten times a second; what is stored is the whole stroke at pen-up. */
import type { SketchPx } from '../geometry/points';

const kEveryMs = 100;

export class InkStream {
  readonly #send: (strokeId: string, points: readonly SketchPx[]) => void;
  #strokeId = '';
  #waiting: SketchPx[] = [];
  #lastMs = -Infinity;

  constructor(send: (strokeId: string, points: readonly SketchPx[]) => void) {
    this.#send = send;
  }

  begin(strokeId: string): void {
    this.#strokeId = strokeId;
    this.#waiting = [];
    this.#lastMs = -Infinity;
  }

  add(p: SketchPx, nowMs: number): void {
    this.#waiting.push(p);
    if (nowMs - this.#lastMs < kEveryMs) return;
    this.#lastMs = nowMs;
    this.#send(this.#strokeId, this.#waiting);
    this.#waiting = [];
  }
}
