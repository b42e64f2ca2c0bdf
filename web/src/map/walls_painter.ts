/** Walls as one prepared path per state: five strokes a frame, however many walls there are. */
import type { Xy } from '../geometry/points';
import type { Table } from '../model/world';
import { type Wall, wallStates, type WallState } from '../wire/parts';
import type { Palette } from './palette';
import { enterWorld, type Frame, type Painter } from './painter';

export interface WallStyle {
  readonly widthPx: number;
  readonly dashPx: readonly number[];
}

export const kWallStyles: Readonly<Record<WallState, WallStyle>> = {
  confirmed: { widthPx: 3.5, dashPx: [] },
  moved: { widthPx: 3.5, dashPx: [] },
  unseen: { widthPx: 2, dashPx: [7, 6] },
  missing: { widthPx: 2.5, dashPx: [2, 5] },
  new: { widthPx: 4, dashPx: [] },
};

const kCrossEveryM = 1;
const kCrossArmM = 0.16;

export class WallsPainter implements Painter {
  revision = 0;
  #paths = new Map<WallState, Path2D>();
  #crosses = new Path2D();
  #hidden: ReadonlySet<WallState> = new Set();
  #opacity = 1;

  setWalls(walls: Table<Wall>): void {
    this.#paths = new Map();
    this.#crosses = new Path2D();
    for (const { a, b, state } of walls.values()) {
      const path = this.#paths.get(state) ?? new Path2D();
      this.#paths.set(state, path);
      path.moveTo(a[0], a[1]);
      path.lineTo(b[0], b[1]);
      if (state === 'missing') addCrosses(this.#crosses, a, b);
    }
    this.revision++;
  }

  setVisible(hidden: ReadonlySet<WallState>, opacity: number): void {
    this.#hidden = hidden;
    this.#opacity = opacity;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterWorld(context, frame);
    context.globalAlpha = this.#opacity;
    context.lineCap = 'round';
    // What is least certain lies lowest.
    for (const state of [...wallStates].reverse()) {
      const path = this.#paths.get(state);
      if (path && !this.#hidden.has(state)) strokeWall(context, path, state, frame.palette, frame.resolution);
    }
    if (this.#hidden.has('missing')) return;
    context.setLineDash([]);
    context.lineWidth = 2 * frame.resolution;
    context.strokeStyle = frame.palette.walls.missing;
    context.stroke(this.#crosses);
  }
}

function strokeWall(context: CanvasRenderingContext2D, path: Path2D, state: WallState, palette: Palette, unit: number): void {
  const { widthPx, dashPx } = kWallStyles[state];
  context.lineWidth = widthPx * unit;
  context.setLineDash(dashPx.map((px) => px * unit));
  context.strokeStyle = palette.walls[state];
  context.stroke(path);
}

/** "This wall is not there": small crosses along it. */
function addCrosses(path: Path2D, a: Xy, b: Xy): void {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const count = Math.max(1, Math.round(length / kCrossEveryM));
  for (let i = 0; i < count; i++) {
    const t = (i + 0.5) / count;
    const x = a[0] + t * (b[0] - a[0]);
    const y = a[1] + t * (b[1] - a[1]);
    for (const sign of [-1, 1]) {
      path.moveTo(x - kCrossArmM, y - sign * kCrossArmM);
      path.lineTo(x + kCrossArmM, y + sign * kCrossArmM);
    }
  }
}
