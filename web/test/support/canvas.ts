/** A canvas that remembers what was drawn on it, for painters without a browser. */
import { kLight } from '../../src/map/palette';
import type { Frame, Painter } from '../../src/map/painter';

export class FakePath {
  readonly calls: (readonly [string, ...unknown[]])[] = [];
  moveTo = (x: number, y: number): void => void this.calls.push(['moveTo', x, y]);
  lineTo = (x: number, y: number): void => void this.calls.push(['lineTo', x, y]);
  arc = (...all: number[]): void => void this.calls.push(['arc', ...all]);
  closePath = (): void => void this.calls.push(['closePath']);
}

export interface Call {
  readonly name: string;
  readonly args: readonly unknown[];
  /** What the context was set to when it was called. */
  readonly state: Readonly<Record<string, unknown>>;
}

export class FakeContext {
  readonly calls: Call[] = [];
  readonly context: CanvasRenderingContext2D;

  constructor() {
    const state: Record<string, unknown> = { globalAlpha: 1, dash: [] };
    this.context = new Proxy({} as CanvasRenderingContext2D, {
      get: (_, name: string) => {
        if (name === 'measureText') return () => ({ width: 40 });
        return (...args: unknown[]) => {
          if (name === 'setLineDash') state['dash'] = args[0];
          this.calls.push({ name, args, state: { ...state } });
        };
      },
      set: (_, name: string, value) => {
        state[name] = value;
        return true;
      },
    });
  }

  of(name: string): Call[] {
    return this.calls.filter((call) => call.name === name);
  }
}

export const frame = (changes: Partial<Frame> = {}): Frame => ({
  toScreen: [10, 0, 0, -10, 100, 100],
  resolution: 0.1,
  rotation: 0,
  size: { width: 200, height: 200 },
  pixelRatio: 2,
  palette: kLight,
  ...changes,
});

export function painted(painter: Painter, changes: Partial<Frame> = {}): FakeContext {
  const canvas = new FakeContext();
  painter.paint(canvas.context, frame(changes));
  return canvas;
}

export function withoutBrowser(): void {
  Object.assign(globalThis, { Path2D: FakePath });
}
