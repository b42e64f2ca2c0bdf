/** A browser without a browser: sockets in memory, time that passes when told. */
import type { SocketLike, Surroundings } from '../../src/link/live_link';

export class FakeSocket implements SocketLike {
  onopen: (() => void) | null = null;
  onmessage: ((data: string | Uint8Array) => void) | null = null;
  onclose: ((code: number) => void) | null = null;
  readonly sent: Record<string, unknown>[] = [];
  closed = false;
  send(text: string): void {
    this.sent.push(JSON.parse(text) as Record<string, unknown>);
  }
  close(): void {
    this.closed = true;
  }
  say(message: object): void {
    this.onmessage?.(JSON.stringify(message));
  }
  of(type: string): Record<string, unknown>[] {
    return this.sent.filter((message) => message['type'] === type);
  }
}

export class FakeSurroundings implements Surroundings {
  now = 1_000_000;
  readonly sockets: FakeSocket[] = [];
  #timers: { at: number; run: () => void }[] = [];
  #ids = 0;
  connect(): FakeSocket {
    const socket = new FakeSocket();
    this.sockets.push(socket);
    return socket;
  }
  nowMs = (): number => this.now;
  random = (): number => 0.5;
  makeId = (): string => `id-${++this.#ids}`;
  after = (ms: number, run: () => void): (() => void) => {
    const timer = { at: this.now + ms, run };
    this.#timers.push(timer);
    return () => (this.#timers = this.#timers.filter((other) => other !== timer));
  };
  async pass(ms: number): Promise<void> {
    const until = this.now + ms;
    for (;;) {
      const next = this.#timers.filter((timer) => timer.at <= until).sort((a, b) => a.at - b.at)[0];
      if (!next) break;
      this.#timers = this.#timers.filter((timer) => timer !== next);
      this.now = next.at;
      next.run();
      await settle();
    }
    this.now = until;
  }
  get socket(): FakeSocket {
    return this.sockets.at(-1)!;
  }
}

export const settle = async (): Promise<void> => {
  for (let i = 0; i < 5; i++) await Promise.resolve();
};
