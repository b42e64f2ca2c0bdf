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
  moved: { widthPx: 5, dashPx: [] },
  unseen: { widthPx: 2, dashPx: [7, 6] },
  missing: { widthPx: 2.5, dashPx: [2, 5] },
  new: { widthPx: 4, dashPx: [] },
};

const kCrossEveryM = 1;
const kCrossArmM = 0.16;

/** The walls of one state as one path; small crosses along those that are not there. */
interface Drawn {
  readonly walls: readonly Wall[];
  readonly path: Path2D;
  readonly crosses: Path2D | undefined;
}

export class WallsPainter implements Painter {
  revision = 0;
  #drawn = new Map<WallState, Drawn>();
  #hidden: ReadonlySet<WallState> = new Set();
  #opacity = 1;

  /** A change of a few walls prepares only the states that they were in and are in now. */
  setWalls(walls: Table<Wall>): void {
    const byState = new Map<WallState, Wall[]>(wallStates.map((state) => [state, []]));
    for (const wall of walls.values()) byState.get(wall.state)!.push(wall);
    for (const [state, list] of byState) {
      const known = this.#drawn.get(state);
      if (!known || !isSame(known.walls, list)) this.#drawn.set(state, draw(list, state));
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
      const drawn = this.#drawn.get(state);
      if (drawn && drawn.walls.length > 0 && !this.#hidden.has(state)) strokeWalls(context, drawn, state, frame.palette, frame.resolution);
    }
  }
}

const isSame = (before: readonly Wall[], now: readonly Wall[]): boolean =>
  before.length === now.length && before.every((wall, i) => wall === now[i]);

function draw(walls: readonly Wall[], state: WallState): Drawn {
  const path = new Path2D();
  const crosses = state === 'missing' ? new Path2D() : undefined;
  for (const { a, b } of walls) {
    path.moveTo(a[0], a[1]);
    path.lineTo(b[0], b[1]);
    if (crosses) addCrosses(crosses, a, b);
  }
  return { walls, path, crosses };
}

function strokeWalls(context: CanvasRenderingContext2D, { path, crosses }: Drawn, state: WallState, palette: Palette, unit: number): void {
  const { widthPx, dashPx } = kWallStyles[state];
  context.lineWidth = widthPx * unit;
  context.setLineDash(dashPx.map((px) => px * unit));
  context.strokeStyle = palette.walls[state];
  context.stroke(path);
  if (!crosses) return;
  context.setLineDash([]);
  context.lineWidth = 2 * unit;
  context.stroke(crosses);
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
