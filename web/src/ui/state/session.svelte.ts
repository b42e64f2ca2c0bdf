/**
 * What the page knows and can do, for every component: the world as the server tells it, this person's own acts on top,
 * the state of the link, and one way to send a command. Components read runes; nothing here touches the page.
 */
import type { MapPoint } from '../../geometry/points';
import type { Api } from '../../link/api';
import { LiveLink, type Surroundings } from '../../link/live_link';
import type { Entry, Outbox } from '../../link/outbox';
import type { Restored, SavedState } from '../../model/saved';
import { saveState } from '../../model/saved';
import { isReflected, type PendingCommand, withPending } from '../../model/pending';
import { linkWord, type LinkWord } from '../../model/status';
import { TileStore } from '../../model/tiles';
import { emptyHistory, type History, record, redo, undo } from '../../model/undo';
import { apply, kEmptyWorld, type World } from '../../model/world';
import { type Command, mayCommand } from '../../wire/commands';
import type { Message } from '../../wire/messages';
import type { Role } from '../../wire/parts';
import { saidWithin, t } from '../i18n.svelte';
import { Stop } from './stop.svelte';
import { Toasts } from './toasts.svelte';

export type Mode = 'prepare' | 'sketch' | 'match' | 'operate' | 'review';
export const kModes: readonly Mode[] = ['prepare', 'sketch', 'match', 'operate', 'review'];

export interface Identity {
  readonly token: string;
  readonly device: string;
  readonly name: string;
  readonly role: Role;
}

/** Where the last state is kept for a reload. */
export interface Keeping {
  changed(): void;
  acted(): void;
}

export type InkListener = (ink: Message<'ink'>) => void;

const kTickMs = 500;
const kLookEveryMs = 500;
/** An acknowledged act whose effect does not show within this time is no longer drawn as ours. */
const kForgetAckedMs = 3_000;
/** A page that was just loaded tries for so long before it says that there is no link. */
const kConnectingMs = 1_500;
const kAnswersKept = 50;

export class Session {
  readonly me: Identity;
  readonly api: Api;
  readonly tiles = new TileStore();
  readonly toasts = new Toasts();
  readonly stop: Stop;

  mode = $state<Mode>('operate');
  nowMs = $state(0);
  linkWord = $state<LinkWord>('connecting');
  linkAgeMs = $state<number | null>(null);
  resolutionM = $state(0.05);
  pending = $state.raw<readonly PendingCommand[]>([]);
  history = $state.raw<History<Command>>(emptyHistory());
  #published = $state.raw<World>(kEmptyWorld);
  /** What everybody did, as the server tells it, with this person's waiting acts on top. */
  readonly world: World;

  /** Newer than what is published: a burst of deltas becomes one update of the page. */
  #latest: World = kEmptyWorld;
  #publishing = false;
  #epoch = 0;
  #lookedMs = 0;
  readonly #acked = new Map<string, { command: Command; createdMs: number; ackedMs: number }>();
  readonly #outbox: Outbox;
  readonly #around: Surroundings;
  readonly #link: LiveLink;
  readonly #inkListeners = new Set<InkListener>();
  readonly #waiters = new Map<string, (ok: boolean) => void>();
  /** Answers that came before somebody waited for them. */
  readonly #answers = new Map<string, boolean>();
  readonly #keeping: Keeping;
  readonly #startedMs: number;
  /** When the state that a reload found on the disk was heard. */
  #keptFromMs: number | null = null;

  /** @param kept from before a reload. @param keeping is told that the state is another one than the last that was kept. */
  constructor(
    me: Identity,
    api: Api,
    outbox: Outbox,
    around: Surroundings,
    onUnauthorised: () => void,
    kept?: Restored,
    keeping: Keeping = { changed: () => {}, acted: () => {} },
  ) {
    this.me = me;
    this.world = $derived(withPending(this.#published, this.pending, me.name));
    this.api = api;
    this.#outbox = outbox;
    this.#around = around;
    this.#keeping = keeping;
    this.#startedMs = around.nowMs();
    if (kept) this.#restore(kept);
    const offset = kept?.head.clockOffsetMs ?? 0;
    this.#link = new LiveLink(around, this.#handlers(onUnauthorised), outbox, me.token, () => this.#position(), offset);
    this.stop = new Stop(() => this.send({ name: 'emergency_stop', data: { robot: '', engaged: true } }), around.after);
  }

  start(): void {
    this.#link.start();
    this.#tick();
  }

  get serverNowMs(): number {
    return this.#link.serverNowMs();
  }
  get link(): LiveLink {
    return this.#link;
  }
  /** Acts that wait for a link. */
  get waiting(): number {
    return this.pending.length;
  }

  newId(): string {
    return this.#around.makeId();
  }

  /** Why this person may not do it, in words; undefined when they may. */
  whyNot(command: Command['name']): string | undefined {
    const allowed = mayCommand(this.me.role, { name: command, data: { engaged: false } } as unknown as Command);
    if (allowed) return undefined;
    return this.me.role === 'observer' ? t('role.observerMay') : t('role.commanderOnly');
  }

  async send(command: Command): Promise<string> {
    if (!mayCommand(this.me.role, command)) {
      this.toasts.show('warning', t('role.commanderOnly'));
      return '';
    }
    return this.#link.send(command);
  }

  /**
   * Resolves when the server has carried the command out or refused it, however long the link takes to come back; what
   * was refused or has expired was said to the person already.
   */
  async sendAndWait(command: Command): Promise<{ readonly ok: boolean; readonly message: string }> {
    const id = await this.send(command);
    if (!id) return { ok: false, message: '' };
    const early = this.#answers.get(id);
    if (early !== undefined) return { ok: early, message: '' };
    return new Promise((resolve) => this.#waiters.set(id, (ok) => resolve({ ok, message: '' })));
  }
  #answered(id: string, ok: boolean): void {
    const waiter = this.#waiters.get(id);
    this.#waiters.delete(id);
    if (waiter) waiter(ok);
    else this.#answers.set(id, ok);
    for (const oldest of this.#answers.keys()) {
      if (this.#answers.size <= kAnswersKept) break;
      this.#answers.delete(oldest);
    }
  }

  /** Carries out `forward` and remembers how to take it back. */
  act(forward: readonly Command[], backward: readonly Command[]): void {
    this.history = record(this.history, { forward, backward });
    for (const command of forward) void this.send(command);
  }
  undo(): void {
    this.#replay(undo(this.history));
  }
  redo(): void {
    this.#replay(redo(this.history));
  }
  #replay(step: { commands: readonly Command[]; history: History<Command> } | undefined): void {
    if (!step) return;
    this.history = step.history;
    for (const command of step.commands) void this.send(command);
  }

  onInk(listener: InkListener): () => void {
    this.#inkListeners.add(listener);
    return () => this.#inkListeners.delete(listener);
  }

  /** Tells the others where this person looks, at most twice a second. */
  looksAt(p: MapPoint | null, radius = 0): void {
    const now = this.#around.nowMs();
    if (p && now - this.#lookedMs < kLookEveryMs) return;
    this.#lookedMs = now;
    this.#link.presence(this.mode, p);
    if (p) this.#link.look({ x: p[0], y: p[1], radius });
  }

  /** To be kept on the disk; nothing before the server was heard. */
  get state(): SavedState | undefined {
    const { lastHeardMs, clockOffsetMs } = this.#link;
    if (lastHeardMs === null || this.#epoch === 0) return undefined;
    return saveState(this.#latest, this.tiles, { heardMs: lastHeardMs, clockOffsetMs, resolutionM: this.resolutionM });
  }

  #restore({ head, world, tiles }: Restored): void {
    this.#epoch = head.epoch;
    this.#latest = this.#published = world;
    this.#keptFromMs = head.heardMs;
    this.resolutionM = head.resolutionM;
    this.tiles.restore(head.epoch, head.seq, tiles);
  }

  #position(): { epoch: number; seq: number; parts?: Record<string, number> } {
    const position = this.tiles.position;
    // Revisions count within one run of the server; those of another run say nothing.
    return position.epoch === this.#epoch && this.#epoch !== 0 ? { ...position, parts: { ...this.#latest.revisions } } : position;
  }

  #handlers(unauthorised: () => void): ConstructorParameters<typeof LiveLink>[1] {
    return {
      unauthorised,
      welcome: ({ epoch, resolution_m }) => this.#onWelcome(epoch, resolution_m),
      delta: (delta) => this.#onDelta(delta),
      tiles: async (frame) => {
        await this.tiles.add(frame);
        this.#keeping.changed();
        await nextFrame();
      },
      done: (entry) => this.#onDone(entry),
      refused: (entry, message) => {
        this.stop.answered(entry.id, false);
        this.#answered(entry.id, false);
        this.toasts.show('warning', t('link.refused', { what: nameOf(entry.command), why: saidWithin(message) }));
        this.#updatePending();
      },
      expired: (entry) => {
        this.#answered(entry.id, false);
        this.toasts.show('warning', t('link.expired', { what: nameOf(entry.command) }));
      },
      ink: (ink) => this.#inkListeners.forEach((listener) => listener(ink)),
      changed: () => this.#updateLink(),
    };
  }

  #onWelcome(epoch: number, resolutionM: number): void {
    if (epoch !== this.#epoch) this.#latest = kEmptyWorld;
    this.#epoch = epoch;
    this.resolutionM = resolutionM;
    this.tiles.enterEpoch(epoch);
    this.looksAt(null);
    this.#publish();
  }

  #onDelta(delta: Message<'delta'>): void {
    const applied = apply(this.#latest, delta);
    if (!applied.ok) return;
    this.#latest = applied.world;
    this.#publish();
  }

  #onDone(entry: Entry): void {
    this.stop.answered(entry.id, true);
    this.#answered(entry.id, true);
    this.#keeping.acted();
    this.#acked.set(entry.id, { command: entry.command, createdMs: entry.createdMs, ackedMs: this.#around.nowMs() });
    this.#updatePending();
  }

  #publish(): void {
    this.#keeping.changed();
    if (this.#publishing) return;
    this.#publishing = true;
    void nextFrame().then(() => {
      this.#publishing = false;
      this.#published = this.#latest;
      this.#updatePending();
    });
  }

  #updatePending(): void {
    const now = this.#around.nowMs();
    for (const [id, { command, ackedMs }] of this.#acked) {
      if (isReflected(this.#latest, command) || now - ackedMs > kForgetAckedMs) this.#acked.delete(id);
    }
    const acked = [...this.#acked].map(([id, { command, createdMs }]) => ({ id, command, createdMs }));
    const next: PendingCommand[] = [...acked, ...this.#outbox.entries];
    if (next.length > 0 || this.pending.length > 0) this.pending = next;
  }

  #updateLink(): void {
    const now = this.#around.nowMs();
    const heard = this.#link.lastHeardMs ?? this.#keptFromMs;
    this.linkAgeMs = heard === null ? null : now - heard;
    const isTrying = this.#link.lastHeardMs === null && now - this.#startedMs < kConnectingMs;
    this.linkWord = isTrying ? 'connecting' : linkWord(this.#link.connected, this.linkAgeMs);
    if (this.#outbox.entries.length !== this.pending.length) this.#updatePending();
  }

  #tick(): void {
    this.nowMs = this.serverNowMs;
    this.#updateLink();
    this.#around.after(kTickMs, () => this.#tick());
  }
}

const nameOf = (command: Command): string => t(`command.${command.name}`);

/** The next painted frame; half a second in a hidden tab, which throttles the map to what nobody looks at. */
function nextFrame(): Promise<void> {
  return new Promise((resolve) => {
    if (document.hidden) setTimeout(resolve, 500);
    else requestAnimationFrame(() => resolve());
  });
}
