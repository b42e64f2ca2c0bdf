/** Lines and handles of whatever is being edited: thin, above everything, always the same size on the screen. */
import type { ViewPoint } from '../geometry/points';
import { enterScreen, type Frame, lineTo, type Painter, place } from './painter';
import { arrow } from './marks_painter';
import type { Palette } from './palette';

export type Tone = 'accent' | 'danger' | 'warning' | 'ok' | 'muted' | 'ink' | 'plan' | 'door';

export type Shape =
  | { readonly kind: 'line'; readonly points: readonly ViewPoint[]; readonly tone: Tone; readonly widthPx: number; readonly dashed?: boolean; readonly closed?: boolean }
  | { readonly kind: 'handle'; readonly p: ViewPoint; readonly tone: Tone; readonly radiusPx: number; readonly active?: boolean }
  | { readonly kind: 'cross'; readonly p: ViewPoint; readonly tone: Tone }
  | { readonly kind: 'arrow'; readonly p: ViewPoint; readonly heading: number; readonly tone: Tone; readonly lengthPx: number }
  | { readonly kind: 'text'; readonly p: ViewPoint; readonly text: string };

const colour = (palette: Palette, tone: Tone): string => palette[tone];

export class OverlayPainter implements Painter {
  revision = 0;
  #shapes: readonly Shape[] = [];

  setShapes(shapes: readonly Shape[]): void {
    this.#shapes = shapes;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterScreen(context, frame);
    context.lineCap = 'round';
    context.lineJoin = 'round';
    for (const shape of this.#shapes) paintShape(context, frame, shape);
  }
}

function paintShape(context: CanvasRenderingContext2D, frame: Frame, shape: Shape): void {
  switch (shape.kind) {
    case 'line':
      return paintLine(context, frame, shape);
    case 'handle':
      return paintHandle(context, frame, shape);
    case 'cross': {
      const [x, y] = place(frame, shape.p);
      context.lineWidth = 2.5;
      context.strokeStyle = colour(frame.palette, shape.tone);
      context.beginPath();
      for (const sign of [-1, 1]) {
        context.moveTo(x - 9, y - 9 * sign);
        context.lineTo(x + 9, y + 9 * sign);
      }
      return context.stroke();
    }
    case 'arrow': {
      const [x, y] = place(frame, shape.p);
      return arrow(context, x, y, shape.heading - frame.rotation, shape.lengthPx, colour(frame.palette, shape.tone));
    }
    case 'text':
      return paintText(context, frame, shape);
  }
}

function paintLine(context: CanvasRenderingContext2D, frame: Frame, shape: Extract<Shape, { kind: 'line' }>): void {
  context.beginPath();
  for (const p of shape.points) lineTo(context, place(frame, p));
  if (shape.closed) context.closePath();
  context.lineWidth = shape.widthPx;
  context.setLineDash(shape.dashed ? [8, 7] : []);
  context.strokeStyle = colour(frame.palette, shape.tone);
  context.stroke();
  context.setLineDash([]);
}

/** A ring that leaves the point itself visible. */
function paintHandle(context: CanvasRenderingContext2D, frame: Frame, shape: Extract<Shape, { kind: 'handle' }>): void {
  const [x, y] = place(frame, shape.p);
  context.beginPath();
  context.arc(x, y, shape.radiusPx, 0, 2 * Math.PI);
  context.globalAlpha = shape.active ? 0.35 : 0.18;
  context.fillStyle = colour(frame.palette, shape.tone);
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 5;
  context.strokeStyle = frame.palette.halo;
  context.stroke();
  context.lineWidth = 2.5;
  context.strokeStyle = colour(frame.palette, shape.tone);
  context.stroke();
  context.beginPath();
  context.arc(x, y, 2.5, 0, 2 * Math.PI);
  context.fillStyle = colour(frame.palette, shape.tone);
  context.fill();
}

function paintText(context: CanvasRenderingContext2D, frame: Frame, { p, text }: Extract<Shape, { kind: 'text' }>): void {
  const [x, y] = place(frame, p);
  context.font = '700 15px system-ui, sans-serif';
  const width = context.measureText(text).width + 16;
  context.fillStyle = frame.palette.text;
  context.beginPath();
  context.roundRect(x - width / 2, y - 34, width, 24, 8);
  context.fill();
  context.fillStyle = frame.palette.halo;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(text, x, y - 22);
}
