/** Colours of everything that is painted on a canvas. One source: the legend draws its swatches from here too. */
import type { WallState } from '../wire/parts';

export type ThemeName = 'light' | 'dark';

export interface Palette {
  readonly name: ThemeName;
  readonly background: string;
  readonly sheet: string;
  readonly grid: string;
  readonly text: string;
  readonly halo: string;
  readonly muted: string;
  readonly ink: string;
  readonly door: string;
  readonly accent: string;
  readonly danger: string;
  readonly warning: string;
  readonly ok: string;
  readonly plan: string;
  readonly walls: Readonly<Record<WallState, string>>;
  /** RGB of the sixteen cell codes; the first, unknown, is left transparent. */
  readonly cells: readonly (readonly [number, number, number])[];
  /** Soft fills for pairs of rooms; eight that differ for colour-blind eyes too (after Okabe and Ito). */
  readonly regions: readonly string[];
}

type Rgb = readonly [number, number, number];

const mix = (from: Rgb, to: Rgb, t: number): Rgb => [
  Math.round(from[0] + (to[0] - from[0]) * t),
  Math.round(from[1] + (to[1] - from[1]) * t),
  Math.round(from[2] + (to[2] - from[2]) * t),
];

/** Codes 0 unknown, 1..6 free (1 surest), 7..13 occupied (13 surest), 14 plan only, 15 plan says wall but nothing is there. */
function cells(unknown: Rgb, free: Rgb, wall: Rgb, planOnly: Rgb, wrong: Rgb): Rgb[] {
  const frees = [1, 2, 3, 4, 5, 6].map((code) => mix(free, unknown, ((code - 1) / 5) * 0.6));
  const walls = [7, 8, 9, 10, 11, 12, 13].map((code) => mix(mix(unknown, wall, 0.35), wall, (code - 7) / 6));
  return [unknown, ...frees, ...walls, planOnly, wrong];
}

const kRegions = ['#e69f00', '#56b4e9', '#009e73', '#f0d13a', '#4f7fd6', '#d5694a', '#cc79a7', '#8e7cc3', '#7fb36b', '#b08d57'];

export const kLight: Palette = {
  name: 'light',
  background: '#e3e7ea',
  sheet: '#fdfdfb',
  grid: '#d5dbe0',
  text: '#14191e',
  halo: '#ffffff',
  muted: '#7b8791',
  ink: '#1b2530',
  door: '#c2257f',
  accent: '#0a63c9',
  danger: '#c8102e',
  warning: '#b85c00',
  ok: '#0b7a45',
  plan: '#8a3ffc',
  walls: { confirmed: '#1b2530', moved: '#0a63c9', unseen: '#8995a0', missing: '#d9660a', new: '#0b8a4d' },
  cells: cells([227, 231, 234], [255, 255, 255], [74, 84, 94], [205, 214, 224], [250, 214, 180]),
  regions: kRegions,
};

export const kDark: Palette = {
  name: 'dark',
  background: '#0e1317',
  sheet: '#181f25',
  grid: '#28323a',
  text: '#eef2f5',
  halo: '#0b0f12',
  muted: '#84919c',
  ink: '#eef2f5',
  door: '#ff86c8',
  accent: '#62a8ff',
  danger: '#ff5a6b',
  warning: '#ffab4d',
  ok: '#4cd38c',
  plan: '#c39bff',
  walls: { confirmed: '#eef2f5', moved: '#62a8ff', unseen: '#6f7d89', missing: '#ff9440', new: '#45d08a' },
  cells: cells([14, 19, 23], [44, 54, 63], [176, 188, 198], [34, 46, 60], [84, 52, 26]),
  regions: kRegions,
};

export const paletteOf = (theme: ThemeName): Palette => (theme === 'dark' ? kDark : kLight);
export const regionColour = (palette: Palette, index: number): string =>
  palette.regions[((index % palette.regions.length) + palette.regions.length) % palette.regions.length]!;
