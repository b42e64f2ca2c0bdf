/** Walls of a plan in its own pixels: as read (doubtful ones dashed, switched-off ones faint), or as drawn, laid over the map. */
import type { Xy } from '../geometry/points';
import type { Affine } from '../geometry/similarity';
import { enterWorld, type Frame, type Painter } from './painter';
import type { Tone } from './overlay_painter';

export interface PlanWall {
  readonly a: Xy;
  readonly b: Xy;
  readonly look: 'sure' | 'doubtful' | 'off' | 'own';
}

/** A gap between walls of the plan. */
export interface PlanOpening {
  readonly a: Xy;
  readonly b: Xy;
  readonly kind: 'door' | 'window' | 'passage';
}

/** Doors closed lines, windows close dashes, passages a thin dotted line: told apart without their colour. */
const kOpenings: Readonly<Record<PlanOpening['kind'], { readonly widthPx: number; readonly dashPx: readonly number[] }>> = {
  door: { widthPx: 4, dashPx: [] },
  window: { widthPx: 4, dashPx: [3, 5] },
  passage: { widthPx: 2, dashPx: [1, 5] },
};

const kTones: Readonly<Record<PlanWall['look'], Tone>> = { sure: 'accent', doubtful: 'warning', off: 'muted', own: 'ok' };

export class PlanWallsPainter implements Painter {
  revision = 0;
  #paths = new Map<PlanWall['look'], Path2D>();
  #openings = new Map<PlanOpening['kind'], Path2D>();
  #toView: Affine = [1, 0, 0, -1, 0, 0];
  #tone: Tone | undefined;
  #opacity = 1;

  /** @param toView layout_px -> view; the default lays the plan at its own pixels. */
  setWalls(walls: readonly PlanWall[], openings: readonly PlanOpening[] = []): void {
    this.#paths = new Map();
    for (const { a, b, look } of walls) {
      const path = this.#paths.get(look) ?? new Path2D();
      this.#paths.set(look, path);
      path.moveTo(a[0], a[1]);
      path.lineTo(b[0], b[1]);
    }
    this.#openings = new Map();
    for (const { a, b, kind } of openings) {
      const path = this.#openings.get(kind) ?? new Path2D();
      this.#openings.set(kind, path);
      path.moveTo(a[0], a[1]);
      path.lineTo(b[0], b[1]);
    }
    this.revision++;
  }

  /** Where the plan lies, and one colour for all of it. */
  setPlacement(toView: Affine, tone: Tone): void {
    this.#toView = toView;
    this.#tone = tone;
    this.revision++;
  }

  setOpacity(opacity: number): void {
    this.#opacity = opacity;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    if (this.#opacity <= 0) return;
    enterWorld(context, frame);
    context.transform(...this.#toView);
    const unit = frame.resolution / Math.hypot(this.#toView[0], this.#toView[1]);
    context.lineCap = 'round';
    for (const [look, path] of this.#paths) {
      context.globalAlpha = this.#opacity * (look === 'off' ? 0.55 : 0.95);
      context.lineWidth = (look === 'off' ? 1.5 : 3) * unit;
      context.setLineDash(look === 'doubtful' ? [7 * unit, 6 * unit] : look === 'off' ? [2 * unit, 5 * unit] : []);
      context.strokeStyle = frame.palette[this.#tone ?? kTones[look]];
      context.stroke(path);
    }
    context.globalAlpha = this.#opacity;
    context.strokeStyle = frame.palette.door;
    for (const [kind, path] of this.#openings) {
      const { widthPx, dashPx } = kOpenings[kind];
      context.lineWidth = widthPx * unit;
      context.setLineDash(dashPx.map((px) => px * unit));
      context.stroke(path);
    }
  }
}
