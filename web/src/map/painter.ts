/** What draws on a canvas of the map. Painters hold prepared paths; painting a frame is a few calls on each. */
import type { Affine, Size } from '../geometry/similarity';
import { applyAffine } from '../geometry/similarity';
import { type ScreenPoint, screenPoint, type ViewPoint } from '../geometry/points';
import type { Palette } from './palette';

export interface Frame {
  /** View coordinates -> CSS pixels. */
  readonly toScreen: Affine;
  /** View units per CSS pixel: a width of w pixels is w * resolution in the world. */
  readonly resolution: number;
  readonly rotation: number;
  readonly size: Size;
  readonly pixelRatio: number;
  readonly palette: Palette;
}

export interface Painter {
  /** Grows whenever the next frame would look different although the view did not move. */
  readonly revision: number;
  paint(context: CanvasRenderingContext2D, frame: Frame): void;
}

/** Makes the canvas speak view coordinates; lengths such as line widths then count in world units. */
export function enterWorld(context: CanvasRenderingContext2D, { toScreen, pixelRatio }: Frame): void {
  const [a, b, c, d, e, f] = toScreen;
  context.setTransform(a * pixelRatio, b * pixelRatio, c * pixelRatio, d * pixelRatio, e * pixelRatio, f * pixelRatio);
}

/** Makes the canvas speak CSS pixels. */
export function enterScreen(context: CanvasRenderingContext2D, { pixelRatio }: Frame): void {
  context.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
}

export function place({ toScreen }: Frame, p: ViewPoint): ScreenPoint {
  const [x, y] = applyAffine(toScreen, p);
  return screenPoint(x, y);
}

export const lineTo = (context: CanvasRenderingContext2D, p: ScreenPoint): void => context.lineTo(p[0], p[1]);
