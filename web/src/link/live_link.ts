/**
 * The socket: says hello with what is known already, keeps the map flowing by returning credits, repeats what was not
 * acknowledged, and comes back by itself with a jittered back-off. It never reloads the page. Everything from outside
 * (socket, clock, timers, chance) is injected, so each of these habits is tested without a browser.
 */
import type { Command } from '../wire/commands';
import { timeToLive } from '../wire/commands';
import { type ClientMessage, encode, type Message, parseServerMessage, type View } from '../wire/messages';
import { parseTileFrame, type TileFrame } from '../wire/tile_frame';
import { backoffMs } from './backoff';
import type { Entry, Outbox } from './outbox';

export interface SocketLike {
  send(text: string): void;
  close(): void;
  onopen: (() => void) | null;
  onmessage: ((data: string | Uint8Array) => void) | null;
  onclose: ((code: number) => void) | null;
}

export interface Surroundings {
  connect(): SocketLike;
  nowMs(): number;
  random(): number;
  makeId(): string;
  /** Returns how to call it off. */
  after(ms: number, run: () => void): () => void;
}

export interface LinkHandlers {
  welcome(message: Message<'welcome'>): void;
  delta(message: Message<'delta'>): void;
  /** Resolves when the tiles were drawn: then the credit goes back. */
  tiles(frame: TileFrame): Promise<void>;
  done(entry: Entry): void;
  refused(entry: Entry, message: string): void;
  expired(entry: Entry): void;
  ink(message: Message<'ink'>): void;
  /** Connection came or went, a frame arrived, the number of waiting commands changed. */
  changed(): void;
  /** The server no longer knows this device: pair again. */
  unauthorised(): void;
}

/** What the browser holds already, said in `hello`. */
export interface Position {
  readonly epoch: number;
  readonly seq: number;
  readonly parts?: Readonly<Record<string, number>>;
}

const kPingEveryMs = 1_000;
const kSilenceMs = 10_000;
const kCloseUnauthorised = 4001;

export class LiveLink {
  readonly #around: Surroundings;
  readonly #handlers: LinkHandlers;
  readonly #outbox: Outbox;
  readonly #token: string;
  readonly #position: () => Position;
  #socket: SocketLike | null = null;
  #welcomed = false;
  #stopped = false;
  #attempt = 0;
  #lastHeardMs: number | null = null;
  #clockOffsetMs: number;
  #bestRoundTripMs = Infinity;
  #cancelTimer: () => void = () => {};
  /** Bad frames since the start; shown in the link's details, never fatal. */
  malformed = 0;

  constructor(
    around: Surroundings,
    handlers: LinkHandlers,
    outbox: Outbox,
    token: string,
    position: () => Position,
    /** From before a reload, until the server tells its clock. */
    clockOffsetMs = 0,
  ) {
    this.#around = around;
    this.#handlers = handlers;
    this.#outbox = outbox;
    this.#token = token;
    this.#position = position;
    this.#clockOffsetMs = clockOffsetMs;
  }

  get connected(): boolean {
    return this.#welcomed;
  }
  get lastHeardMs(): number | null {
    return this.#lastHeardMs;
  }
  get roundTripMs(): number | null {
    return Number.isFinite(this.#bestRoundTripMs) ? this.#bestRoundTripMs : null;
  }
  get clockOffsetMs(): number {
    return this.#clockOffsetMs;
  }
  /** This device's idea of the server's clock. */
  serverNowMs(): number {
    return this.#around.nowMs() + this.#clockOffsetMs;
  }

  start(): void {
    this.#stopped = false;
    this.#open();
  }

  stop(): void {
    this.#stopped = true;
    this.#cancelTimer();
    this.#socket?.close();
  }

  /** The device says the network is back: do not sit out the back-off. */
  hurry(): void {
    if (this.#socket || this.#stopped) return;
    this.#cancelTimer();
    this.#attempt = 0;
    this.#open();
  }

  /** Kept on disk, then sent as soon as there is a link. Resolves with the command's id when it is on disk. */
  async send(command: Command): Promise<string> {
    const now = this.#around.nowMs();
    const ttl = timeToLive(command);
    const id = this.#around.makeId();
    // Sent first when there is a link: an emergency stop does not wait for a disk.
    const expires = ttl === undefined ? null : this.serverNowMs() + ttl;
    const kept = this.#outbox.add(id, command, now, expires);
    const entry = this.#outbox.get(id);
    if (entry) this.#transmit(entry);
    this.#handlers.changed();
    await kept;
    return id;
  }

  look(view: View): void {
    this.#say({ type: 'view', ...view });
  }

  presence(mode: string, p: readonly [number, number] | null): void {
    this.#say({ type: 'presence', mode, p });
  }

  ink(strokeId: string, points: readonly (readonly [number, number])[]): void {
    this.#say({ type: 'ink', stroke_id: strokeId, points });
  }

  #open(): void {
    const socket = this.#around.connect();
    this.#socket = socket;
    this.#schedule(kSilenceMs, () => this.#checkSilence());
    socket.onopen = () => {
      socket.send(encode({ type: 'hello', token: this.#token, version: 1, ...this.#position() }));
    };
    socket.onmessage = (data) => {
      if (socket === this.#socket) this.#receive(data);
    };
    socket.onclose = (code) => {
      if (socket === this.#socket) this.#closed(code);
    };
  }

  #schedule(ms: number, run: () => void): void {
    this.#cancelTimer();
    this.#cancelTimer = this.#around.after(ms, run);
  }

  #closed(code: number): void {
    this.#socket = null;
    this.#welcomed = false;
    this.#cancelTimer();
    this.#handlers.changed();
    if (this.#stopped) return;
    if (code === kCloseUnauthorised) {
      this.#stopped = true;
      this.#handlers.unauthorised();
      return;
    }
    this.#schedule(backoffMs(this.#attempt++, this.#around.random()), () => this.#open());
  }

  #beat(): void {
    if (this.#checkSilence()) return;
    this.#say({ type: 'ping', t: this.#around.nowMs() });
    void this.#outbox.expire(this.serverNowMs()).then((late) => late.forEach((entry) => this.#handlers.expired(entry)));
    this.#schedule(kPingEveryMs, () => this.#beat());
  }

  /** A half-open connection looks fine until one asks it: after ten silent seconds it counts as gone. */
  #checkSilence(): boolean {
    const heard = this.#lastHeardMs;
    const silent = !this.#welcomed || (heard !== null && this.#around.nowMs() - heard >= kSilenceMs);
    if (!silent) return false;
    const socket = this.#socket;
    this.#closed(0);
    socket?.close();
    return true;
  }

  #receive(data: string | Uint8Array): void {
    this.#lastHeardMs = this.#around.nowMs();
    if (typeof data === 'string') this.#receiveText(data);
    else this.#receiveTiles(data);
    this.#handlers.changed();
  }

  #receiveTiles(data: Uint8Array): void {
    const frame = parseTileFrame(data);
    if (!frame) {
      this.malformed++;
      return;
    }
    const socket = this.#socket;
    void this.#handlers.tiles(frame).then(() => {
      if (socket === this.#socket && frame.type === 'tiles') this.#say({ type: 'ack', seq: frame.seq });
    });
  }

  #receiveText(text: string): void {
    const message = parseServerMessage(text);
    switch (message?.type) {
      case undefined:
        this.malformed++;
        return;
      case 'welcome':
        return this.#onWelcome(message);
      case 'delta':
        return this.#handlers.delta(message);
      case 'done':
        void this.#outbox.settle(message.id).then((entry) => entry && this.#handlers.done(entry));
        return;
      case 'refused':
        void this.#outbox.settle(message.id).then((entry) => entry && this.#handlers.refused(entry, message.message));
        return;
      case 'pong':
        return this.#onPong(message);
      case 'ink':
        return this.#handlers.ink(message);
      case 'bye':
        return;
    }
  }

  #onWelcome(message: Message<'welcome'>): void {
    this.#welcomed = true;
    this.#attempt = 0;
    this.#bestRoundTripMs = Infinity;
    this.#clockOffsetMs = message.server_ms - this.#around.nowMs();
    this.#handlers.welcome(message);
    void this.#resend();
    this.#beat();
  }

  async #resend(): Promise<void> {
    const late = await this.#outbox.expire(this.serverNowMs());
    late.forEach((entry) => this.#handlers.expired(entry));
    this.#outbox.entries.forEach((entry) => this.#transmit(entry));
  }

  /** The exchange with the shortest way there and back says most about the clocks. */
  #onPong({ t, server_ms }: Message<'pong'>): void {
    const now = this.#around.nowMs();
    const roundTrip = now - t;
    if (roundTrip < 0 || roundTrip > this.#bestRoundTripMs) return;
    this.#bestRoundTripMs = roundTrip;
    this.#clockOffsetMs = server_ms - (t + roundTrip / 2);
  }

  #transmit(entry: Entry): void {
    if (!this.#welcomed) return;
    const expires = entry.expiresMs === null ? {} : { expires_ms: Math.round(entry.expiresMs) };
    this.#say({ type: 'command', id: entry.id, ...entry.command, ...expires });
  }

  #say(message: ClientMessage): void {
    if (this.#welcomed) this.#socket?.send(encode(message));
  }
}
