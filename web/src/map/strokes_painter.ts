/** Pen strokes. perfect-freehand shapes them for the eye only; what is stored and sent are the points of the pen. */
import { getStroke } from 'perfect-freehand';
import type { Xy } from '../geometry/points';
import { densify } from '../geometry/simplify';
import type { Stroke, StrokeKind } from '../wire/parts';
import type { Palette } from './palette';
import { enterWorld, type Frame, type Painter } from './painter';

const kSpacingPx = 3;

export type ShownStroke = Pick<Stroke, 'kind' | 'width' | 'points'>;

export function strokePath({ points, width }: Pick<Stroke, 'points' | 'width'>): Path2D {
  const path = new Path2D();
  const only = points[0];
  if (points.length < 2 && only) {
    path.arc(only[0], -only[1], width / 2, 0, 2 * Math.PI);
    return path;
  }
  // Few points far apart would be rounded off into another shape than the one that is read: no streamlining, and enough points.
  const outline = getStroke(densify(points, kSpacingPx), { size: width, thinning: 0, smoothing: 0.3, streamline: 0, last: true });
  for (const [x, y] of outline) path.lineTo(x!, -y!);
  path.closePath();
  return path;
}

const colourOf = (palette: Palette, kind: StrokeKind): string =>
  kind === 'door' ? palette.door : kind === 'note' ? palette.warning : palette.ink;

export class StrokesPainter implements Painter {
  revision = 0;
  #paths = new Map<string, { stroke: ShownStroke; path: Path2D }>();
  #faded = new Set<string>();

  setStrokes(strokes: ReadonlyMap<string, ShownStroke>): void {
    const next = new Map<string, { stroke: ShownStroke; path: Path2D }>();
    for (const [id, stroke] of strokes) {
      const known = this.#paths.get(id);
      next.set(id, known && known.stroke.points === stroke.points ? known : { stroke, path: strokePath(stroke) });
    }
    this.#paths = next;
    this.revision++;
  }

  /** Under the eraser, not yet erased. */
  setFaded(ids: ReadonlySet<string>): void {
    this.#faded = new Set(ids);
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterWorld(context, frame);
    for (const [id, { stroke, path }] of this.#paths) {
      context.globalAlpha = this.#faded.has(id) ? 0.2 : 1;
      context.fillStyle = colourOf(frame.palette, stroke.kind);
      context.fill(path);
    }
  }
}

/** The strokes that are being drawn right now: ours, and those of others as they come. */
export class LiveInkPainter implements Painter {
  revision = 0;
  #own: { kind: StrokeKind; width: number; points: Xy[] } | null = null;
  readonly #others = new Map<string, { points: Xy[]; name: string }>();

  begin(kind: StrokeKind, width: number): void {
    this.#own = { kind, width, points: [] };
    this.revision++;
  }
  add(points: readonly Xy[]): void {
    this.#own?.points.push(...points);
    this.revision++;
  }
  end(): void {
    this.#own = null;
    this.revision++;
  }

  addOther(strokeId: string, name: string, points: readonly Xy[]): void {
    const known = this.#others.get(strokeId) ?? { points: [], name };
    known.points.push(...points);
    this.#others.set(strokeId, known);
    this.revision++;
  }
  /** The whole stroke arrived by the log, or its author stopped. */
  dropOthers(ids: Iterable<string>): void {
    for (const id of ids) if (this.#others.delete(id)) this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterWorld(context, frame);
    if (this.#own && this.#own.points.length > 0) {
      context.fillStyle = colourOf(frame.palette, this.#own.kind);
      context.fill(strokePath(this.#own));
    }
    context.globalAlpha = 0.5;
    context.fillStyle = frame.palette.accent;
    for (const { points } of this.#others.values()) context.fill(strokePath({ points, width: 3 }));
  }
}
