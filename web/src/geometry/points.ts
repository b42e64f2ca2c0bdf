/**
 * Points know their frame: passing a pixel of the plan where metres are wanted does not compile.
 * Frames are those of docs/frames.md; `screen` is CSS pixels of one canvas, y down.
 */
export type Xy = readonly [x: number, y: number];

declare const frame: unique symbol;
/** Optional, so that a plain pair from the wire fits; two different frames never do. */
type InFrame<Name extends string> = Xy & { readonly [frame]?: Name };

/** Metres in the corrected world, y up. */
export type MapPoint = InFrame<'map'>;
/** Pixels of the rectified picture of the plan, y down. */
export type LayoutPx = InFrame<'layout_px'>;
/** Pixels of the sheet that is sketched on, y down. */
export type SketchPx = InFrame<'sketch_px'>;
/** CSS pixels from the upper left corner of a canvas, y down. */
export type ScreenPoint = InFrame<'screen'>;
/** What the view works in: the world of one canvas with y up. Pixels of pictures are flipped into it once, here. */
export type ViewPoint = InFrame<'view'>;

export const mapPoint = (x: number, y: number): MapPoint => [x, y];
export const layoutPx = (x: number, y: number): LayoutPx => [x, y];
export const sketchPx = (x: number, y: number): SketchPx => [x, y];
export const screenPoint = (x: number, y: number): ScreenPoint => [x, y];
export const viewPoint = (x: number, y: number): ViewPoint => [x, y];

/** A picture's pixel in view coordinates and back: y changes its sign, nothing else. */
export const pixelToView = (p: LayoutPx | SketchPx): ViewPoint => viewPoint(p[0], -p[1]);
export const viewToLayout = (p: ViewPoint): LayoutPx => layoutPx(p[0], -p[1]);
export const viewToSketch = (p: ViewPoint): SketchPx => sketchPx(p[0], -p[1]);
/** The map has y up already. */
export const mapToView = (p: MapPoint): ViewPoint => viewPoint(p[0], p[1]);
export const viewToMap = (p: ViewPoint): MapPoint => mapPoint(p[0], p[1]);

export const distance = (a: Xy, b: Xy): number => Math.hypot(a[0] - b[0], a[1] - b[1]);
export const midpoint = <P extends Xy>(a: P, b: P): P => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] as unknown as P;
/** Direction from `a` to `b`, radians counter-clockwise from +x where y is up. */
export const headingFrom = (a: Xy, b: Xy): number => Math.atan2(b[1] - a[1], b[0] - a[0]);
