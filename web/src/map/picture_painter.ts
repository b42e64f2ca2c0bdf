/**
 * A picture on the canvas: a plan as it was uploaded, or bent by the mesh to where its walls lie now. Bending is done once
 * per mesh into a picture of its own, not once per frame.
 */
import { boundsOf, type Bounds } from '../geometry/bounds';
import { triangleAffine, type PlanMesh } from '../geometry/mesh';
import type { Xy } from '../geometry/points';
import { enterWorld, type Frame, type Painter } from './painter';

const kLargestSidePx = 2048;
/** Triangles overlap by this much: anti-aliased edges would show as hair lines. */
const kOverlapPx = 0.75;

export class PicturePainter implements Painter {
  revision = 0;
  #picture: ImageBitmap | null = null;
  #mesh: PlanMesh | null = null;
  #bent: { canvas: HTMLCanvasElement; bounds: Bounds } | null = null;
  #opacity = 1;

  setPicture(picture: ImageBitmap | null): void {
    this.#picture = picture;
    this.#bent = null;
    this.revision++;
  }

  /** Without a mesh the picture lies at its own pixels, y flipped. */
  setMesh(mesh: PlanMesh | null): void {
    this.#mesh = mesh;
    this.#bent = null;
    this.revision++;
  }

  setOpacity(opacity: number): void {
    this.#opacity = opacity;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    if (!this.#picture || this.#opacity <= 0) return;
    enterWorld(context, frame);
    context.globalAlpha = this.#opacity;
    if (!this.#mesh) {
      context.scale(1, -1);
      context.drawImage(this.#picture, 0, 0);
      return;
    }
    this.#bent ??= bend(this.#picture, this.#mesh);
    if (!this.#bent) return;
    const { canvas, bounds } = this.#bent;
    context.translate(bounds.minX, bounds.maxY);
    context.scale((bounds.maxX - bounds.minX) / canvas.width, -(bounds.maxY - bounds.minY) / canvas.height);
    context.drawImage(canvas, 0, 0);
  }
}

function bend(picture: ImageBitmap, mesh: PlanMesh): { canvas: HTMLCanvasElement; bounds: Bounds } | null {
  const bounds = boundsOf(mesh.map);
  const width = bounds.maxX - bounds.minX;
  const height = bounds.maxY - bounds.minY;
  if (!(width > 0) || !(height > 0)) return null;
  const scale = kLargestSidePx / Math.max(width, height);
  const canvas = document.createElement('canvas');
  canvas.width = Math.ceil(width * scale);
  canvas.height = Math.ceil(height * scale);
  const context = canvas.getContext('2d')!;
  const toCanvas = (p: Xy): Xy => [(p[0] - bounds.minX) * scale, (bounds.maxY - p[1]) * scale];
  for (const [i, j, k] of mesh.triangles) {
    const [a, b, c] = [mesh.px[i], mesh.px[j], mesh.px[k]];
    const [u, v, w] = [mesh.map[i], mesh.map[j], mesh.map[k]];
    if (a && b && c && u && v && w) drawTriangle(context, picture, [a, b, c], [toCanvas(u), toCanvas(v), toCanvas(w)]);
  }
  return { canvas, bounds };
}

function drawTriangle(
  context: CanvasRenderingContext2D,
  picture: ImageBitmap,
  from: readonly [Xy, Xy, Xy],
  to: readonly [Xy, Xy, Xy],
): void {
  const affine = triangleAffine(from, to);
  if (!affine) return;
  const middleX = (to[0][0] + to[1][0] + to[2][0]) / 3;
  const middleY = (to[0][1] + to[1][1] + to[2][1]) / 3;
  context.save();
  context.beginPath();
  for (const [x, y] of to) {
    const away = Math.hypot(x - middleX, y - middleY) || 1;
    context.lineTo(x + ((x - middleX) / away) * kOverlapPx, y + ((y - middleY) / away) * kOverlapPx);
  }
  context.clip();
  context.transform(...affine);
  context.drawImage(picture, 0, 0);
  context.restore();
}
