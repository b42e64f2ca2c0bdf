/** Preparing a plan, step by step: picture, corners, walls, scale, where the robot stands. Nothing blocks; any step may be skipped. */
import { headingFrom, type LayoutPx, layoutPx } from '../../geometry/points';
import { snapToWalls } from '../../geometry/snap';
import { addWall, documentOf, draftFrom, type PlanDraft, toggleWall, wallAt, withScale } from '../../model/plan_draft';
import type { World } from '../../model/world';
import { t } from '../i18n.svelte';
import type { Pictures } from './pictures';
import type { Session } from './session.svelte';

export type Step = 'picture' | 'corners' | 'walls' | 'scale' | 'start';
export const kSteps: readonly Step[] = ['picture', 'corners', 'walls', 'scale', 'start'];

interface Source {
  readonly planId: string;
  readonly width: number;
  readonly height: number;
  readonly picture: ImageBitmap | null;
}

export interface Start {
  readonly p: LayoutPx;
  /** Counter-clockwise from the picture's +x. */
  readonly heading: number;
}

const kCornerInset = 0.03;

const defaultCorners = (width: number, height: number): LayoutPx[] => {
  const [x, y] = [width * kCornerInset, height * kCornerInset];
  return [layoutPx(x, y), layoutPx(width - x, y), layoutPx(width - x, height - y), layoutPx(x, height - y)];
};

export class Prepare {
  step = $state<Step>('picture');
  busy = $state('');
  source = $state.raw<Source | null>(null);
  corners = $state.raw<readonly LayoutPx[]>([]);
  rectified = $state.raw<ImageBitmap | null>(null);
  scalePoints = $state.raw<readonly LayoutPx[]>([]);
  start = $state.raw<Start | null>(null);
  warnings = $state.raw<readonly string[]>([]);
  sent = $state(false);
  #drafts = $state.raw<readonly PlanDraft[]>([]);
  #at = $state(-1);
  readonly draft: PlanDraft | undefined = $derived(this.#drafts[this.#at]);

  readonly #session: Session;
  readonly #pictures: Pictures;

  constructor(session: Session, pictures: Pictures) {
    this.#session = session;
    this.#pictures = pictures;
  }

  get canUndo(): boolean {
    return this.#at > 0;
  }
  get canRedo(): boolean {
    return this.#at + 1 < this.#drafts.length;
  }
  undo(): void {
    if (this.canUndo) this.#at--;
  }
  redo(): void {
    if (this.canRedo) this.#at++;
  }
  #edit(draft: PlanDraft): void {
    this.#drafts = [...this.#drafts.slice(0, this.#at + 1), draft];
    this.#at = this.#drafts.length - 1;
    this.sent = false;
  }

  /** Uploads, then reads at once: walls over the picture come before any question. */
  async upload(file: Blob): Promise<void> {
    this.busy = t('prepare.uploading');
    const answer = await this.#session.api.uploadPlan(file);
    if (!answer.ok) return this.#fail(answer.message);
    const { plan_id, width, height, warnings } = answer.value;
    this.warnings = warnings;
    const picture = await this.#pictures.get(`/api/plans/${plan_id}/picture`);
    this.source = { planId: plan_id, width: picture?.width ?? width, height: picture?.height ?? height, picture };
    this.corners = defaultCorners(this.source.width, this.source.height);
    this.#drafts = [];
    this.#at = -1;
    this.start = null;
    this.scalePoints = [];
    await this.read(false);
  }

  async read(withCorners: boolean): Promise<void> {
    const source = this.source;
    if (!source) return;
    this.busy = t('prepare.reading');
    const answer = await this.#session.api.readPlan(source.planId, withCorners ? { corners: [...this.corners] } : {});
    if (!answer.ok) {
      this.step = 'corners';
      return this.#fail(answer.message);
    }
    const { layout, rectified } = answer.value;
    const proposed = layout.sheet_corners;
    if (!withCorners && proposed?.length === 4) this.corners = proposed;
    this.rectified = await this.#pictures.get(rectified);
    this.warnings = layout.warnings;
    this.#edit(draftFrom(source.planId, rectified, layout));
    this.scalePoints = [];
    this.busy = '';
    this.step = 'walls';
  }

  #fail(message: string): void {
    this.busy = '';
    this.#session.toasts.show('warning', message);
  }

  moveCorner(index: number, p: LayoutPx): void {
    this.corners = this.corners.map((corner, i) => (i === index ? p : corner));
  }

  /** Switches the wall under the finger off or on; false when there is none. */
  tapWall(p: LayoutPx, reach: number): boolean {
    const index = this.draft && wallAt(this.draft, p, reach);
    if (this.draft === undefined || index === undefined) return false;
    this.#edit(toggleWall(this.draft, index));
    return true;
  }

  snap(p: LayoutPx, reach: number, from?: LayoutPx): LayoutPx {
    const walls = this.draft?.walls.filter((wall) => wall.on).map(({ a, b }) => [a, b] as const) ?? [];
    return snapToWalls(p, walls, reach, from).p;
  }

  drawWall(a: LayoutPx, b: LayoutPx): void {
    if (this.draft) this.#edit(addWall(this.draft, a, b));
  }

  tapScale(p: LayoutPx): void {
    this.scalePoints = this.scalePoints.length >= 2 ? [p] : [...this.scalePoints, p];
  }

  setScale(metres: number): void {
    const [a, b] = this.scalePoints;
    const scaled = this.draft && a && b && withScale(this.draft, a, b, metres);
    if (scaled) this.#edit(scaled);
    else this.#session.toasts.show('warning', t('prepare.scaleInvalid'));
  }

  placeStart(p: LayoutPx): void {
    this.start = { p, heading: this.start?.heading ?? 0 };
    this.sent = false;
  }
  turnStart(towards: LayoutPx): void {
    if (!this.start) return;
    const { p } = this.start;
    // y of the picture points down; headings turn where y is up.
    this.start = { p, heading: headingFrom([p[0], -p[1]], [towards[0], -towards[1]]) };
  }

  async send(world: World): Promise<void> {
    const draft = this.draft;
    if (draft) {
      this.busy = t('prepare.sending');
      const command = { name: 'set_layout', data: { plan_id: draft.planId, layout: documentOf(draft) } } as const;
      const answer = await this.#session.api.command(this.#session.newId(), command);
      this.busy = '';
      if (!answer.ok) return this.#fail(answer.message);
    }
    const robot = [...world.tables.robots.keys()][0] ?? 'robot1';
    if (this.start) await this.#session.send({ name: 'set_start', data: { robot, px: this.start.p, heading: this.start.heading } });
    this.sent = true;
    this.#session.toasts.show('ok', t('prepare.sent'));
  }
}
