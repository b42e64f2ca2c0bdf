/**
 * One canvas of the page: OpenLayers' map and view with our own coordinates (metres of the map, or pixels of a picture with
 * y flipped) and our own painters. Gestures do not come from OpenLayers: `tools` decides what a finger means and moves the
 * view with `setView`.
 */
import OlMap from 'ol/Map.js';
import Projection from 'ol/proj/Projection.js';
import View from 'ol/View.js';
import { type Bounds, isEmpty } from '../geometry/bounds';
import { type Box, type Limits, middle, uncovered, zoomAbout } from '../geometry/gesture';
import { type ScreenPoint, type ViewPoint, viewPoint } from '../geometry/points';
import { type Size, toScreen, toView, type ViewState } from '../geometry/similarity';
import { CanvasLayer } from './canvas_layer';
import type { Palette } from './palette';
import type { Painter } from './painter';

/** Plain Cartesian units: no globe, no degrees. */
const kFlat = new Projection({ code: 'smokemap:flat', units: 'm', global: false, worldExtent: [-1e6, -1e6, 1e6, 1e6] });

export const kMapLimits: Limits = { minResolution: 0.002, maxResolution: 0.5 };
export const kPictureLimits: Limits = { minResolution: 0.05, maxResolution: 12 };

/** CSS pixels at each edge that buttons cover, or that should stay free. */
export interface Insets {
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly left: number;
}

const kFingerPx = 56;

export const kInsets: Insets = { top: 32, right: 32, bottom: 32, left: 32 };

export class Stage {
  readonly limits: Limits;
  readonly #map: OlMap;
  readonly #view: View;
  readonly #layers: readonly CanvasLayer[];

  /** @param layers painters per canvas, bottom first; what changes often goes on a canvas of its own. */
  constructor(target: HTMLElement, layers: readonly (readonly Painter[])[], palette: () => Palette, limits: Limits) {
    this.limits = limits;
    this.#layers = layers.map((painters) => new CanvasLayer(painters, palette));
    this.#view = new View({
      projection: kFlat,
      center: [0, 0],
      resolution: Math.sqrt(limits.minResolution * limits.maxResolution),
      minResolution: limits.minResolution,
      maxResolution: limits.maxResolution,
      constrainRotation: false,
      smoothResolutionConstraint: false,
      showFullExtent: true,
    });
    this.#map = new OlMap({ target, layers: [...this.#layers], view: this.#view, controls: [], interactions: [] });
  }

  get size(): Size {
    const [width = 0, height = 0] = this.#map.getSize() ?? [];
    return { width, height };
  }

  get view(): ViewState {
    const [x = 0, y = 0] = this.#view.getCenter() ?? [];
    return { center: viewPoint(x, y), resolution: this.#view.getResolution() ?? 1, rotation: this.#view.getRotation() };
  }

  setView({ center, resolution, rotation }: ViewState): void {
    this.#view.setCenter([center[0], center[1]]);
    this.#view.setResolution(resolution);
    this.#view.setRotation(rotation);
  }

  toScreen = (p: ViewPoint): ScreenPoint => toScreen(this.view, this.size, p);
  toView = (p: ScreenPoint): ViewPoint => toView(this.view, this.size, p);

  zoom(factor: number, at: ScreenPoint = middle(this.size)): void {
    this.setView(zoomAbout(this.view, at, factor, this.size, this.limits));
  }

  /** Tells of every turn of the view; returns how to stop listening. */
  onTurn(listener: (rotation: number) => void): () => void {
    const tell = (): void => listener(this.#view.getRotation());
    this.#view.on('change:rotation', tell);
    return () => this.#view.un('change:rotation', tell);
  }

  /** Tells of every painted frame that shows another view than the one before, the first included. */
  onView(listener: (view: ViewState) => void): () => void {
    let told = '';
    const tell = (): void => {
      const { view, size } = this;
      const now = [...view.center, view.resolution, view.rotation, size.width, size.height].join(' ');
      if (now === told || size.width === 0) return;
      told = now;
      listener(view);
    };
    this.#map.on('postrender', tell);
    return () => this.#map.un('postrender', tell);
  }

  straighten(): void {
    this.#view.setRotation(0);
  }

  centerOn(p: ViewPoint): void {
    this.#view.setCenter([p[0], p[1]]);
  }

  /** Moves so that a card over the page leaves `p` free. @param card in pixels of the page */
  uncover(p: ViewPoint, card: Box): void {
    const { x = 0, y = 0 } = this.#map.getTargetElement()?.getBoundingClientRect() ?? {};
    const here = { left: card.left - x, right: card.right - x, top: card.top - y, bottom: card.bottom - y };
    this.setView(uncovered(this.view, this.size, p, here, kFingerPx));
  }

  /** Shows all of `bounds` beside what covers the canvas. Without bounds nothing moves. */
  fit(bounds: Bounds, covered: Insets): boolean {
    const { width, height } = this.size;
    if (isEmpty(bounds) || width === 0 || height === 0) return false;
    const across = (bounds.maxX - bounds.minX) / Math.max(1, width - covered.left - covered.right);
    const up = (bounds.maxY - bounds.minY) / Math.max(1, height - covered.top - covered.bottom);
    const resolution = Math.min(this.limits.maxResolution, Math.max(this.limits.minResolution, across, up));
    const x = (bounds.minX + bounds.maxX) / 2 + (resolution * (covered.right - covered.left)) / 2;
    const y = (bounds.minY + bounds.maxY) / 2 + (resolution * (covered.top - covered.bottom)) / 2;
    this.setView({ center: viewPoint(x, y), resolution, rotation: 0 });
    return true;
  }

  /** Something that painters show has changed. */
  refresh(): void {
    this.#map.render();
  }

  /** The element changed its size. */
  resize(): void {
    this.#map.updateSize();
  }

  /** Milliseconds of script in the last painted frame, over all canvases. */
  get lastPaintMs(): number {
    return this.#layers.reduce((sum, layer) => sum + layer.lastPaintMs, 0);
  }

  dispose(): void {
    this.#map.setTarget(undefined);
    this.#map.dispose();
  }
}
