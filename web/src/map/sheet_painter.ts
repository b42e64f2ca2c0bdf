/** The sheet that is sketched on: paper with a faint grid, so that a hand draws straighter. */
import { enterWorld, type Frame, type Painter } from './painter';

const kGridPx = 32;

export class SheetPainter implements Painter {
  revision = 0;
  #width = 1024;
  #height = 768;
  #grid = new Path2D();

  constructor() {
    this.setSize(1024, 768);
  }

  setSize(width: number, height: number): void {
    this.#width = width;
    this.#height = height;
    this.#grid = new Path2D();
    for (let x = kGridPx; x < width; x += kGridPx) {
      this.#grid.moveTo(x, 0);
      this.#grid.lineTo(x, -height);
    }
    for (let y = kGridPx; y < height; y += kGridPx) {
      this.#grid.moveTo(0, -y);
      this.#grid.lineTo(width, -y);
    }
    this.revision++;
  }

  paint(context: CanvasRenderingContext2D, frame: Frame): void {
    enterWorld(context, frame);
    context.fillStyle = frame.palette.sheet;
    context.fillRect(0, -this.#height, this.#width, this.#height);
    context.lineWidth = frame.resolution;
    context.strokeStyle = frame.palette.grid;
    context.stroke(this.#grid);
    context.strokeRect(0, -this.#height, this.#width, this.#height);
  }
}
