/** Rooms as soft fills. Picture coordinates; colours are the caller's, so that both sides of a match agree. */
import { centroid } from '../geometry/polygon';
import { pixelToView, type ViewPoint, type Xy } from '../geometry/points';
import { enterScreen, enterWorld, type Frame, type Painter, place } from './painter';

export interface ShownRegion {
  readonly outline: readonly Xy[];
  /** undefined = a room without a partner: outlined only. */
  readonly fill: string | undefined;
  readonly label: string;
  readonly emphasis: 'none' | 'selected' | 'faded';
  readonly dashed: boolean;
}

interface Prepared extends ShownRegion {
  readonly path: Path2D;
  readonly middle: ViewPoint;
}

export class RegionsPainter implements Painter {
  revision = 0;
  #regions: readonly Prepared[] = [];

  setRegions(regions: readonly ShownRegion[]): void {
    this.#regions = regions
      .filter((region) => region.outline.length >= 3)
      .map((region) => {
        const path = new Path2D();
        for (const [x, y] of region.outline) path.lineTo(x, -y);
        path.closePath();
        return { ...region, path, middle: pixelToView(centroid(region.outline)) };
      });
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterWorld(context, frame);
    for (const { path, fill, emphasis, dashed } of this.#regions) {
      context.globalAlpha = emphasis === 'faded' ? 0.16 : emphasis === 'selected' ? 0.75 : 0.45;
      if (fill) {
        context.fillStyle = fill;
        context.fill(path);
      }
      context.globalAlpha = 1;
      context.lineWidth = (emphasis === 'selected' ? 4 : 1.5) * frame.resolution;
      context.setLineDash(dashed ? [6 * frame.resolution, 5 * frame.resolution] : []);
      context.strokeStyle = emphasis === 'selected' ? frame.palette.text : (fill ?? frame.palette.muted);
      context.stroke(path);
    }
    this.#paintLabels(context, frame);
  }

  #paintLabels(context: CanvasRenderingContext2D, frame: Frame): void {
    enterScreen(context, frame);
    context.setLineDash([]);
    context.font = '600 15px system-ui, sans-serif';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.lineWidth = 4;
    context.lineJoin = 'round';
    for (const { label, middle } of this.#regions) {
      if (!label) continue;
      const [x, y] = place(frame, middle);
      context.strokeStyle = frame.palette.halo;
      context.strokeText(label, x, y);
      context.fillStyle = frame.palette.text;
      context.fillText(label, x, y);
    }
  }
}
