/**
 * The sensed map. Tiles are coloured into sheets of 8 x 8 tiles, so that a frame draws a few large pictures instead of
 * hundreds of small ones; a change of theme colours them again from the cells.
 */
import { type Tile, tileKey, type TileStore } from '../model/tiles';
import { kTileCells } from '../wire/tile_frame';
import type { Palette } from './palette';
import { enterWorld, type Frame, type Painter } from './painter';

const kSheetTiles = 8;
const kSheetCells = kSheetTiles * kTileCells;

interface Sheet {
  readonly canvas: HTMLCanvasElement;
  readonly context: CanvasRenderingContext2D;
  readonly sx: number;
  readonly sy: number;
}

/** One 32-bit RGBA word per cell code, as a canvas keeps it in memory on little-endian machines. */
export function paletteWords(palette: Palette): Uint32Array {
  const words = new Uint32Array(16);
  palette.cells.forEach(([r, g, b], code) => {
    const alpha = code === 0 ? 0 : 255;
    words[code] = ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;
  });
  return words;
}

/** Cells (row 0 = lowest y) as a picture (row 0 = top). */
export function colourCells(cells: Uint8Array, words: Uint32Array, out: Uint32Array): void {
  for (let row = 0; row < kTileCells; row++) {
    const from = row * kTileCells;
    const to = (kTileCells - 1 - row) * kTileCells;
    for (let column = 0; column < kTileCells; column++) out[to + column] = words[cells[from + column]!]!;
  }
}

export class GridPainter implements Painter {
  revision = 0;
  opacity = 1;
  readonly #store: TileStore;
  readonly #stop: () => void;
  readonly #sheets = new Map<string, Sheet>();
  readonly #stale = new Map<string, Tile>();
  readonly #image = new ImageData(kTileCells, kTileCells);
  #colouredFor = '';
  #resolutionM: () => number;

  constructor(store: TileStore, resolutionM: () => number, changed: () => void) {
    this.#store = store;
    this.#resolutionM = resolutionM;
    this.#stop = store.listen((tiles) => {
      if (tiles === 'all') this.#forget();
      else for (const tile of tiles) this.#stale.set(tileKey(tile.tx, tile.ty), tile);
      this.revision++;
      changed();
    });
    this.#forget();
  }

  dispose(): void {
    this.#stop();
  }

  setOpacity(opacity: number): void {
    this.opacity = opacity;
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    if (this.#colouredFor !== frame.palette.name) this.#forget();
    this.#colour(frame.palette);
    if (this.opacity <= 0) return;
    enterWorld(context, frame);
    // Cells keep their edges when one is larger than a few pixels; from afar they are averaged.
    const cell = this.#resolutionM();
    context.imageSmoothingEnabled = cell / frame.resolution < 1;
    context.globalAlpha = this.opacity;
    const side = kSheetCells * cell;
    for (const { canvas, sx, sy } of this.#sheets.values()) {
      context.save();
      context.translate(sx * side, (sy + 1) * side);
      context.scale(cell, -cell);
      context.drawImage(canvas, 0, 0);
      context.restore();
    }
  }

  #forget(): void {
    this.#sheets.clear();
    this.#stale.clear();
    for (const [key, tile] of this.#store.tiles) this.#stale.set(key, tile);
  }

  #colour(palette: Palette): void {
    this.#colouredFor = palette.name;
    if (this.#stale.size === 0) return;
    const words = paletteWords(palette);
    const pixels = new Uint32Array(this.#image.data.buffer);
    for (const { tx, ty, cells } of this.#stale.values()) {
      const sx = Math.floor(tx / kSheetTiles);
      const sy = Math.floor(ty / kSheetTiles);
      colourCells(cells, words, pixels);
      const row = kSheetTiles - 1 - (ty - sy * kSheetTiles);
      this.#sheet(sx, sy).context.putImageData(this.#image, (tx - sx * kSheetTiles) * kTileCells, row * kTileCells);
    }
    this.#stale.clear();
  }

  #sheet(sx: number, sy: number): Sheet {
    const key = tileKey(sx, sy);
    const known = this.#sheets.get(key);
    if (known) return known;
    const canvas = document.createElement('canvas');
    canvas.width = kSheetCells;
    canvas.height = kSheetCells;
    const sheet: Sheet = { canvas, context: canvas.getContext('2d')!, sx, sy };
    this.#sheets.set(key, sheet);
    return sheet;
  }
}
