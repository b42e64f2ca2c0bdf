/**
 * Robots, goals, points of interest and people. Signs keep their size on the screen; what is uncertain carries a ring as
 * wide as its standard deviation, dashed, so that a guess never looks like a fix.
 */
import { mapToView, type ViewPoint } from '../geometry/points';
import type { Goal, Poi, PoiKind, Robot } from '../wire/parts';
import { drawIcon } from './icons';
import type { Palette } from './palette';
import { enterScreen, type Frame, lineTo, type Painter, place } from './painter';

export interface ShownPoi extends Pick<Poi, 'kind' | 'label'> {
  readonly p: ViewPoint;
  /** View units; null = placed here by hand, nothing to doubt. */
  readonly sigma: number | null;
  readonly selected: boolean;
}

export interface ShownGoal extends Pick<Goal, 'state' | 'heading'> {
  readonly p: ViewPoint;
  readonly sigma: number | null;
  readonly number: number;
  readonly ghost: boolean;
}

export interface ShownPerson {
  readonly p: ViewPoint;
  readonly name: string;
}

export interface Marks {
  readonly robots: readonly (Robot & { readonly id: string })[];
  readonly pois: readonly ShownPoi[];
  readonly goals: readonly ShownGoal[];
  readonly people: readonly ShownPerson[];
}

const kPinPx = 17;
const kRobotPx = 15;
const kFont = '600 13px system-ui, sans-serif';

export const poiColour = (palette: Palette, kind: PoiKind): string => {
  if (kind === 'fire' || kind === 'victim') return palette.danger;
  if (kind === 'gas_bottle' || kind === 'hazard' || kind === 'shut_off') return palette.warning;
  if (kind === 'exit' || kind === 'access') return palette.ok;
  return palette.accent;
};

export class MarksPainter implements Painter {
  revision = 0;
  #marks: Marks = { robots: [], pois: [], goals: [], people: [] };

  setMarks(marks: Marks): void {
    this.#marks = marks;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterScreen(context, frame);
    context.textBaseline = 'middle';
    for (const robot of this.#marks.robots) paintPath(context, frame, robot);
    for (const goal of this.#marks.goals) paintGoal(context, frame, goal);
    for (const poi of this.#marks.pois) paintPoi(context, frame, poi);
    for (const robot of this.#marks.robots) paintRobot(context, frame, robot);
    for (const person of this.#marks.people) paintPerson(context, frame, person);
  }
}

function label(context: CanvasRenderingContext2D, text: string, x: number, y: number, palette: Palette): void {
  if (!text) return;
  context.font = kFont;
  context.textAlign = 'center';
  context.lineJoin = 'round';
  context.lineWidth = 4;
  context.setLineDash([]);
  context.strokeStyle = palette.halo;
  context.strokeText(text, x, y);
  context.fillStyle = palette.text;
  context.fillText(text, x, y);
}

/** One standard deviation, only where it is large enough to matter to the eye. */
function ring(context: CanvasRenderingContext2D, frame: Frame, x: number, y: number, sigma: number | null, colour: string): void {
  const radius = sigma === null ? 0 : sigma / frame.resolution;
  if (radius < 6) return;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.globalAlpha = 0.1;
  context.fillStyle = colour;
  context.fill();
  context.globalAlpha = 0.9;
  context.setLineDash([5, 5]);
  context.lineWidth = 2;
  context.strokeStyle = colour;
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}

function disc(context: CanvasRenderingContext2D, x: number, y: number, radius: number, fill: string, edge: string): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = fill;
  context.fill();
  context.lineWidth = 2.5;
  context.strokeStyle = edge;
  context.stroke();
}

function paintPoi(context: CanvasRenderingContext2D, frame: Frame, poi: ShownPoi): void {
  const [x, y] = place(frame, poi.p);
  const colour = poiColour(frame.palette, poi.kind);
  ring(context, frame, x, y, poi.sigma, colour);
  if (poi.selected) disc(context, x, y, kPinPx + 6, frame.palette.halo, frame.palette.text);
  disc(context, x, y, kPinPx, colour, frame.palette.halo);
  context.save();
  context.translate(x, y);
  drawIcon(context, poi.kind, 20, frame.palette.halo);
  context.restore();
  label(context, poi.label, x, y + kPinPx + 12, frame.palette);
}

function paintGoal(context: CanvasRenderingContext2D, frame: Frame, goal: ShownGoal): void {
  const { palette } = frame;
  const [x, y] = place(frame, goal.p);
  const colour = goal.state === 'refused' || goal.state === 'failed' ? palette.muted : palette.accent;
  ring(context, frame, x, y, goal.sigma, colour);
  context.globalAlpha = goal.ghost ? 0.75 : 1;
  if (goal.heading !== null) arrow(context, x, y, goal.heading - frame.rotation, 46, colour);
  disc(context, x, y, kPinPx, palette.halo, colour);
  context.save();
  context.translate(x, y);
  drawIcon(context, 'goal', 20, colour);
  context.restore();
  if (goal.number > 0) label(context, String(goal.number), x + kPinPx + 8, y - kPinPx, palette);
  context.globalAlpha = 1;
}

/** @param heading radians counter-clockwise, as seen on the screen. */
export function arrow(context: CanvasRenderingContext2D, x: number, y: number, heading: number, length: number, colour: string): void {
  context.save();
  context.translate(x, y);
  context.rotate(-heading);
  context.strokeStyle = colour;
  context.lineWidth = 4;
  context.lineCap = 'round';
  context.beginPath();
  context.moveTo(0, 0);
  context.lineTo(length, 0);
  context.moveTo(length - 9, -8);
  context.lineTo(length, 0);
  context.lineTo(length - 9, 8);
  context.stroke();
  context.restore();
}

function paintPath(context: CanvasRenderingContext2D, frame: Frame, robot: Robot): void {
  if (robot.path.length < 2) return;
  context.beginPath();
  for (const p of robot.path) lineTo(context, place(frame, mapToView(p)));
  context.lineJoin = 'round';
  context.strokeStyle = frame.palette.halo;
  context.lineWidth = 6;
  context.stroke();
  context.setLineDash([9, 7]);
  context.strokeStyle = frame.palette.accent;
  context.lineWidth = 3;
  context.stroke();
  context.setLineDash([]);
}

function paintRobot(context: CanvasRenderingContext2D, frame: Frame, robot: Robot & { readonly id: string }): void {
  const { palette } = frame;
  const [x, y] = place(frame, mapToView([robot.x, robot.y]));
  const colour = robot.link === 'lost' ? palette.muted : robot.stopped ? palette.danger : palette.accent;
  ring(context, frame, x, y, robot.sigma_m, colour);
  context.save();
  context.translate(x, y);
  // Heading is counter-clockwise in the map; the view turns clockwise, the screen has y down.
  context.rotate(frame.rotation - robot.heading);
  context.beginPath();
  context.moveTo(kRobotPx * 1.35, 0);
  context.lineTo(-kRobotPx, -kRobotPx * 0.95);
  context.lineTo(-kRobotPx * 0.55, 0);
  context.lineTo(-kRobotPx, kRobotPx * 0.95);
  context.closePath();
  context.lineJoin = 'round';
  context.lineWidth = 5;
  context.strokeStyle = palette.halo;
  context.stroke();
  context.fillStyle = colour;
  context.fill();
  if (!robot.localized) {
    context.lineWidth = 2;
    context.setLineDash([4, 3]);
    context.strokeStyle = palette.text;
    context.stroke();
  }
  context.restore();
  context.setLineDash([]);
  label(context, robot.id, x, y + kRobotPx + 14, palette);
}

function paintPerson(context: CanvasRenderingContext2D, frame: Frame, { p, name }: ShownPerson): void {
  const [x, y] = place(frame, p);
  disc(context, x, y, 7, frame.palette.plan, frame.palette.halo);
  label(context, name, x, y - 18, frame.palette);
}
