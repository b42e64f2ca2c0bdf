/**
 * The last state that this device saw, in a form that survives a reload: shown, with its age, until there is a link again,
 * and what the link then goes on from. Everything is read back through the same checks as the server's own messages.
 */
import { kTileCells } from '../wire/tile_frame';
import { partNames } from '../wire/parts';
import { parseSavedHead, type SavedHead } from '../wire/saved_head';
import type { Tile, TileStore } from './tiles';
import { type World, worldFromSnapshot } from './world';

export interface SavedState extends SavedHead {
  readonly parts: Readonly<Record<string, Record<string, unknown>>>;
  readonly tiles: readonly Tile[];
}

export interface Restored {
  readonly head: SavedHead;
  readonly world: World;
  readonly tiles: readonly Tile[];
}

export function saveState(world: World, tiles: TileStore, times: Pick<SavedHead, 'heardMs' | 'clockOffsetMs' | 'resolutionM'>): SavedState {
  const parts: Record<string, Record<string, unknown>> = {};
  for (const name of partNames) parts[name] = Object.fromEntries(world.tables[name]);
  const { floor, planMesh, sheet } = world;
  parts['info'] = { ...(floor && { floor }), ...(planMesh && { plan_mesh: planMesh, plan_nodes: planMesh }), sketch: sheet };
  return { format: 1, ...tiles.position, ...times, revisions: { ...world.revisions }, parts, tiles: [...tiles.tiles.values()] };
}

/** undefined for what an older version of the page left behind, or what is damaged. */
export function restoreState(value: unknown): Restored | undefined {
  const head = parseSavedHead(value);
  if (!head) return undefined;
  const { parts, tiles } = value as Partial<SavedState>;
  if (typeof parts !== 'object' || !Array.isArray(tiles) || !tiles.every(isTile)) return undefined;
  return { head, tiles, world: { ...worldFromSnapshot(parts), revisions: head.revisions } };
}

const isTile = ({ tx, ty, version, cells }: Partial<Tile>): boolean =>
  [tx, ty, version].every(Number.isSafeInteger) && cells instanceof Uint8Array && cells.length === kTileCells * kTileCells;
