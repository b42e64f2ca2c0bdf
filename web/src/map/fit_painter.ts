/**
 * How the plan was fitted: parts that were stretched (blue) or squeezed (orange) against one scale for all, corners that
 * were linked to what was seen, by their shape as well as their colour, and the points that people fixed, with what is
 * left between where they are and where the plan shows them.
 */
import { mapToView } from '../geometry/points';
import type { ShownAnchor, StretchedTriangle } from '../model/fit';
import { formatMetres } from '../model/status';
import type { PartObject } from '../wire/parts';
import { drawIcon } from './icons';
import { enterScreen, enterWorld, type Frame, type Painter, place } from './painter';

export type Link = PartObject<'links'>;

/** A tenth more or less is as strong as the colour gets: real plans are off by about that. */
const kFullAt = 0.1;
const kStrongest = 0.45;

export class FitPainter implements Painter {
  revision = 0;
  #triangles: readonly { readonly path: Path2D; readonly stretch: number }[] = [];
  #links: readonly Link[] = [];
  #anchors: readonly ShownAnchor[] = [];

  setStretch(triangles: readonly StretchedTriangle[]): void {
    this.#triangles = triangles.map(({ corners, stretch }) => {
      const path = new Path2D();
      for (const [x, y] of corners) path.lineTo(x, y);
      path.closePath();
      return { path, stretch };
    });
    this.revision++;
  }
  setLinks(links: readonly Link[]): void {
    this.#links = links;
    this.revision++;
  }
  setAnchors(anchors: readonly ShownAnchor[]): void {
    this.#anchors = anchors;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    if (this.#triangles.length > 0) {
      enterWorld(context, frame);
      for (const { path, stretch } of this.#triangles) {
        context.globalAlpha = strengthOf(stretch);
        context.fillStyle = stretch > 1 ? frame.palette.accent : frame.palette.warning;
        context.fill(path);
      }
      context.globalAlpha = 1;
    }
    if (this.#links.length === 0 && this.#anchors.length === 0) return;
    enterScreen(context, frame);
    for (const link of this.#links) paintLink(context, frame, link);
    for (const anchor of this.#anchors) paintAnchor(context, frame, anchor);
  }
}

export const strengthOf = (stretch: number): number => Math.min(1, Math.abs(stretch - 1) / kFullAt) * kStrongest;

function paintLink(context: CanvasRenderingContext2D, frame: Frame, { p, state }: Link): void {
  const [x, y] = place(frame, mapToView(p));
  const { palette } = frame;
  context.lineWidth = 2.5;
  context.beginPath();
  if (state === 'rejected') {
    for (const sign of [-1, 1]) {
      context.moveTo(x - 4, y - 4 * sign);
      context.lineTo(x + 4, y + 4 * sign);
    }
    context.strokeStyle = palette.danger;
    context.stroke();
    return;
  }
  context.arc(x, y, state === 'kept' ? 4 : 5, 0, 2 * Math.PI);
  context.fillStyle = state === 'kept' ? palette.ok : palette.halo;
  context.fill();
  context.strokeStyle = state === 'kept' ? palette.halo : palette.warning;
  context.stroke();
}

function paintAnchor(context: CanvasRenderingContext2D, frame: Frame, { at, shown, residualM, outlier }: ShownAnchor): void {
  const { palette } = frame;
  const [x, y] = place(frame, mapToView(at));
  if (shown) {
    const [u, v] = place(frame, mapToView(shown));
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(u, v);
    context.lineWidth = 2.5;
    context.strokeStyle = outlier ? palette.danger : palette.plan;
    context.stroke();
  }
  context.beginPath();
  context.arc(x, y, 14, 0, 2 * Math.PI);
  context.fillStyle = outlier ? palette.danger : palette.plan;
  context.fill();
  context.lineWidth = 2.5;
  context.strokeStyle = palette.halo;
  context.stroke();
  context.translate(x, y);
  drawIcon(context, 'pin', 18, palette.halo);
  context.translate(-x, -y);
  context.font = '600 13px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineWidth = 4;
  context.strokeStyle = palette.halo;
  const text = residualM === undefined ? '?' : formatMetres(residualM);
  context.strokeText(text, x, y + 24);
  context.fillStyle = palette.text;
  context.fillText(text, x, y + 24);
}
