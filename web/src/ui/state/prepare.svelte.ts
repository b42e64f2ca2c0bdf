/**
 * Preparing a plan, step by step: picture, corners, walls, scale, where the robot stands. Nothing blocks; any step may be
 * skipped. Every step is written to the disk, so a reload or an empty battery loses none; putting the plan in use is a
 * command like any other and waits for the link.
 */
import { headingFrom, type LayoutPx, layoutPx } from '../../geometry/points';
import { snapToWalls } from '../../geometry/snap';
import {
  addWall,
  closeOpening,
  documentOf,
  draftFrom,
  drawingAt,
  isRectified,
  nameOpening,
  openingAt,
  type OpeningKind,
  type PlanDraft,
  toggleWall,
  wallAt,
  withScale,
} from '../../model/plan_draft';
import {
  asRead,
  begun,
  canRedo,
  canUndo,
  type Edit,
  edited,
  editOf,
  kNothingPrepared,
  type Preparation,
  redone,
  restorePreparation,
  type Start,
  undone,
} from '../../model/preparation';
import type { Command } from '../../wire/commands';
import { said, t } from '../i18n.svelte';
import type { Pictures } from './pictures';
import type { Session } from './session.svelte';

export type Step = 'picture' | 'corners' | 'walls' | 'scale' | 'start';
export const kSteps: readonly Step[] = ['picture', 'corners', 'walls', 'scale', 'start'];

/** Where the preparation survives a reload. */
export interface Shelf {
  load(): Promise<unknown>;
  save(value: unknown): Promise<void>;
}

const kCornerInset = 0.03;
/** Larger commands do not fit into a message of the socket and go by HTTP. */
const kSocketBytes = 200_000;
/** Larger files are refused whatever is in them. */
const kMostUploadBytes = 25_000_000;

const defaultCorners = (width: number, height: number): LayoutPx[] => {
  const [x, y] = [width * kCornerInset, height * kCornerInset];
  return [layoutPx(x, y), layoutPx(width - x, y), layoutPx(width - x, height - y), layoutPx(x, height - y)];
};

export class Prepare {
  step = $state<Step>('picture');
  busy = $state('');
  /** The picture as taken, and after the four corners. */
  picture = $state.raw<ImageBitmap | null>(null);
  rectified = $state.raw<ImageBitmap | null>(null);
  scalePoints = $state.raw<readonly LayoutPx[]>([]);
  warnings = $state.raw<readonly string[]>([]);
  /** The document that was chosen, while its pages can be turned. */
  pdf = $state.raw<{ readonly file: Blob; readonly page: number } | null>(null);
  /** A page that was refused because it takes long to draw; who has patience may ask again. */
  slow = $state.raw<{ readonly file: Blob; readonly page: number } | null>(null);
  /** What was amiss with the file itself: no reading makes it good. */
  #ofUpload: readonly string[] = [];
  #state = $state.raw<Preparation>(kNothingPrepared);
  /** What a finger holds right now; becomes a step when it is let go. */
  #held = $state.raw<Partial<Edit> | null>(null);
  readonly #edit: Edit = $derived({ ...editOf(this.#state), ...this.#held });

  readonly #session: Session;
  readonly #pictures: Pictures;
  readonly #shelf: Shelf;

  constructor(session: Session, pictures: Pictures, shelf: Shelf) {
    this.#session = session;
    this.#pictures = pictures;
    this.#shelf = shelf;
  }

  /** With what this device prepared before the page was loaded. */
  static begin(session: Session, pictures: Pictures, shelf: Shelf): Prepare {
    const prepare = new Prepare(session, pictures, shelf);
    void prepare.restore();
    return prepare;
  }

  /** Goes on where this device stopped before the page was loaded. */
  async restore(): Promise<void> {
    const kept = restorePreparation(await this.#shelf.load().catch(() => null));
    if (!kept.source || this.#state.source) return;
    this.#state = kept;
    this.step = this.draft ? 'walls' : 'corners';
    await this.#loadPictures();
  }

  get source(): Preparation['source'] {
    return this.#state.source;
  }
  get draft(): PlanDraft | undefined {
    return this.#edit.draft ?? undefined;
  }
  get corners(): readonly LayoutPx[] {
    return this.#edit.corners;
  }
  get start(): Start | null {
    return this.#edit.start;
  }
  get sent(): boolean {
    return this.#state.sent;
  }
  get taps(): number {
    return this.#state.taps;
  }
  get canUndo(): boolean {
    return canUndo(this.#state);
  }
  get canRedo(): boolean {
    return canRedo(this.#state);
  }

  undo(): void {
    this.#put(undone(this.#state));
  }
  redo(): void {
    this.#put(redone(this.#state));
  }
  /** Back to the plan in use. */
  discard(): void {
    this.pdf = null;
    this.picture = this.rectified = null;
    this.scalePoints = [];
    this.step = 'picture';
    this.#put(kNothingPrepared);
  }

  #put(state: Preparation): void {
    const reading = editOf(this.#state).draft?.rectified;
    this.#state = state;
    this.#held = null;
    void this.#shelf.save(state).catch(() => undefined);
    if (editOf(state).draft?.rectified !== reading) void this.#loadPictures();
  }
  #change(change: Partial<Edit>): void {
    this.#put(edited(this.#state, change));
  }
  #changeDraft(change: (draft: PlanDraft) => PlanDraft | undefined): boolean {
    const next = this.draft && change(this.draft);
    if (next) this.#change({ draft: next });
    return next !== undefined;
  }

  async #loadPictures(): Promise<void> {
    const { source, draft } = this;
    const get = (url: string | undefined): Promise<ImageBitmap | null> => (url ? this.#pictures.get(url) : Promise.resolve(null));
    const taken = source ? `/api/plans/${source.planId}/picture` : undefined;
    const [picture, rectified] = await Promise.all([get(taken), get(draft?.rectified)]);
    if (source !== this.source || draft?.rectified !== this.draft?.rectified) return;
    [this.picture, this.rectified] = [picture, rectified];
  }

  /** Uploads, then reads at once: walls over the picture come before any question. */
  async upload(file: Blob, page = 1, patient = false): Promise<void> {
    const isPdf = file.type === 'application/pdf';
    this.slow = null;
    this.busy = t('prepare.uploading');
    const answer = await this.#session.api.uploadPlan(file, page, patient);
    if (!answer.ok) {
      if (isPdf && !patient && answer.status === 413 && file.size <= kMostUploadBytes) this.slow = { file, page };
      return this.#fail(answer.message);
    }
    const { plan_id, width, height, warnings } = answer.value;
    this.pdf = isPdf ? { file, page } : null;
    this.warnings = this.#ofUpload = warnings;
    this.scalePoints = [];
    this.#put(begun({ planId: plan_id, width, height }, defaultCorners(width, height)));
    await this.#loadPictures();
    await this.read(false);
  }

  /** The page that was refused for its time, however long the server is willing to draw it. */
  async drawSlow(): Promise<void> {
    if (this.slow) await this.upload(this.slow.file, this.slow.page, true);
  }

  /** Another page of the same document; where there is none, the server says how many there are. */
  async turnPage(by: -1 | 1): Promise<void> {
    if (this.pdf && this.pdf.page + by >= 1) await this.upload(this.pdf.file, this.pdf.page + by);
  }

  /** Another drawing of the sheet is the floor that is meant; false when there is none under the finger. */
  async choosePlan(p: LayoutPx): Promise<boolean> {
    if (!this.draft || !drawingAt(this.draft, p)) return false;
    await this.read(isRectified(this.draft), p);
    return true;
  }

  /** @param planAt of several drawings on the sheet the one at this place */
  async read(withCorners: boolean, planAt?: LayoutPx): Promise<void> {
    const source = this.source;
    if (!source) return;
    this.busy = t('prepare.reading');
    const answer = await this.#session.api.readPlan(source.planId, {
      ...(withCorners && { corners: [...this.corners] }),
      ...(planAt && { plan_at: planAt }),
    });
    if (source !== this.source) return;
    if (!answer.ok) {
      this.step = 'corners';
      return this.#fail(answer.message);
    }
    const { layout, rectified } = answer.value;
    const proposed = !withCorners && layout.sheet_corners?.length === 4 ? layout.sheet_corners : this.corners;
    this.warnings = [...this.#ofUpload, ...layout.warnings];
    this.scalePoints = [];
    this.#put(asRead(this.#state, { corners: proposed, draft: draftFrom(source.planId, rectified, layout) }));
    await this.#loadPictures();
    this.busy = '';
    this.step = 'walls';
  }

  #fail(message: string): void {
    this.busy = '';
    this.#session.toasts.show('warning', said(message));
  }

  holdCorner(index: number, p: LayoutPx): void {
    this.#held = { corners: this.corners.map((corner, i) => (i === index ? p : corner)) };
  }
  holdStart(p: LayoutPx): void {
    this.#held = { start: { p, heading: this.start?.heading ?? 0 } };
  }
  turnStart(towards: LayoutPx): void {
    if (!this.start) return;
    const { p } = this.start;
    // y of the picture points down; headings turn where y is up.
    this.#held = { start: { p, heading: headingFrom([p[0], -p[1]], [towards[0], -towards[1]]) } };
  }
  /** The finger is lifted: what it held counts. */
  letGo(): void {
    if (this.#held) this.#change(this.#held);
  }
  dropHeld(): void {
    this.#held = null;
  }

  /** Switches the wall under the finger off or on; false when there is none. */
  tapWall(p: LayoutPx, reach: number): boolean {
    return this.#changeDraft((draft) => {
      const index = wallAt(draft, p, reach);
      return index === undefined ? undefined : toggleWall(draft, index);
    });
  }
  openingAt(p: LayoutPx, reach: number): number | undefined {
    return this.draft && openingAt(this.draft, p, reach);
  }
  nameOpening(index: number, kind: OpeningKind | 'wall'): void {
    this.#changeDraft((draft) => (kind === 'wall' ? closeOpening(draft, index) : nameOpening(draft, index, kind)));
  }

  snap(p: LayoutPx, reach: number, from?: LayoutPx): LayoutPx {
    const walls = this.draft?.walls.filter((wall) => wall.on).map(({ a, b }) => [a, b] as const) ?? [];
    return snapToWalls(p, walls, reach, from).p;
  }
  drawWall(a: LayoutPx, b: LayoutPx): void {
    this.#changeDraft((draft) => addWall(draft, a, b));
  }

  tapScale(p: LayoutPx): void {
    this.scalePoints = this.scalePoints.length >= 2 ? [p] : [...this.scalePoints, p];
  }
  setScale(metres: number): void {
    const [a, b] = this.scalePoints;
    const isSet = !!a && !!b && this.#changeDraft((draft) => withScale(draft, a, b, metres));
    if (!isSet) this.#session.toasts.show('warning', t('prepare.scaleInvalid'));
  }

  /** Puts the plan in use, and says where `robot` stands on it. Without a link both wait for it. */
  async send(robot: string): Promise<void> {
    const { draft, start } = this;
    if (draft && !(await this.#sendLayout(draft))) return;
    if (start) void this.#session.send({ name: 'set_start', data: { robot, px: start.p, heading: start.heading } });
    this.#put({ ...this.#state, sent: true });
    this.#session.toasts.show('ok', t('prepare.sent'));
  }

  async #sendLayout(draft: PlanDraft): Promise<boolean> {
    const command: Command = { name: 'set_layout', data: { plan_id: draft.planId, layout: documentOf(draft) } };
    this.busy = t('prepare.sending');
    const settled =
      JSON.stringify(command).length < kSocketBytes
        ? await this.#session.sendAndWait(command)
        : await this.#session.api.command(this.#session.newId(), command);
    this.busy = '';
    // What the socket refused was said by the session already.
    if (!settled.ok && settled.message) this.#session.toasts.show('warning', said(settled.message));
    return settled.ok;
  }
}
