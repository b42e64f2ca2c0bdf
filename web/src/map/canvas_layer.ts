/**
 * A layer of OpenLayers that paints itself on one canvas. Vector layers cost 40 to 130 ms of script a frame with 5 000
 * walls; a handful of prepared paths cost about one. A frame in which nothing changed is not painted again.
 */
import Layer from 'ol/layer/Layer.js';
import type { FrameState } from 'ol/Map.js';
import { viewPoint } from '../geometry/points';
import { viewToScreenAffine } from '../geometry/similarity';
import type { Palette } from './palette';
import type { Frame, Painter } from './painter';

export class CanvasLayer extends Layer {
  readonly #painters: readonly Painter[];
  readonly #palette: () => Palette;
  readonly #canvas = document.createElement('canvas');
  #painted = '';
  /** Milliseconds of script of the last painted frame, for the performance figures. */
  lastPaintMs = 0;

  constructor(painters: readonly Painter[], palette: () => Palette) {
    super({});
    this.#painters = painters;
    this.#palette = palette;
    this.#canvas.className = 'map-canvas';
  }

  override render(state: FrameState | null): HTMLElement {
    if (!state) return this.#canvas;
    const began = performance.now();
    const frame = this.#frame(state);
    const key = this.#key(frame);
    if (key === this.#painted) return this.#canvas;
    this.#painted = key;
    const context = this.#prepare(frame);
    for (const painter of this.#painters) {
      context.save();
      painter.paint(context, frame);
      context.restore();
    }
    this.lastPaintMs = performance.now() - began;
    return this.#canvas;
  }

  #frame({ viewState, size, pixelRatio }: FrameState): Frame {
    const box = { width: size[0]!, height: size[1]! };
    const { resolution, rotation } = viewState;
    const center = viewPoint(viewState.center[0]!, viewState.center[1]!);
    const toScreen = viewToScreenAffine({ center, resolution, rotation }, box);
    return { toScreen, resolution, rotation, size: box, pixelRatio, palette: this.#palette() };
  }

  #key({ toScreen, size, pixelRatio, palette }: Frame): string {
    const revisions = this.#painters.map((painter) => painter.revision);
    return [...toScreen, size.width, size.height, pixelRatio, palette.name, ...revisions].join(' ');
  }

  #prepare({ size, pixelRatio }: Frame): CanvasRenderingContext2D {
    const width = Math.round(size.width * pixelRatio);
    const height = Math.round(size.height * pixelRatio);
    const context = this.#canvas.getContext('2d')!;
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      this.#canvas.width = width;
      this.#canvas.height = height;
    } else {
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, width, height);
    }
    return context;
  }
}
