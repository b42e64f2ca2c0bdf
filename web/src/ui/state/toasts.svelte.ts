export type ToastTone = 'info' | 'ok' | 'warning';

export interface Toast {
  readonly id: number;
  readonly tone: ToastTone;
  readonly text: string;
}

const kShownMs = 6_000;
const kAtMost = 4;

/** Short messages that go away by themselves. The same message twice is shown once. */
export class Toasts {
  list = $state.raw<readonly Toast[]>([]);
  #next = 1;

  show(tone: ToastTone, text: string): void {
    const id = this.#next++;
    this.list = [...this.list.filter((toast) => toast.text !== text), { id, tone, text }].slice(-kAtMost);
    setTimeout(() => this.dismiss(id), kShownMs);
  }

  dismiss(id: number): void {
    this.list = this.list.filter((toast) => toast.id !== id);
  }
}
