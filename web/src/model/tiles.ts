/**
 * The sensed map as cells. Held apart from the world because it is large and changes in place; whoever paints it listens
 * for the tiles that changed. Tiles decode out of order, so each keeps its version and an older one never wins.
 */
import { decodeTile, type TileFrame } from '../wire/tile_frame';

export interface Tile {
  readonly tx: number;
  readonly ty: number;
  readonly version: number;
  readonly cells: Uint8Array;
}

export const tileKey = (tx: number, ty: number): string => `${tx},${ty}`;

export type TileListener = (changed: readonly Tile[] | 'all') => void;

export class TileStore {
  #epoch = 0;
  #seq = 0;
  #complete = false;
  readonly #tiles = new Map<string, Tile>();
  readonly #listeners = new Set<TileListener>();

  /** What to say in `hello`: the last frame that is wholly in here. */
  get position(): { readonly epoch: number; readonly seq: number } {
    return { epoch: this.#epoch, seq: this.#seq };
  }
  /** The end of the first snapshot was seen: what is blank is unknown, not late. */
  get complete(): boolean {
    return this.#complete;
  }
  get tiles(): ReadonlyMap<string, Tile> {
    return this.#tiles;
  }

  listen(listener: TileListener): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  /** Forgets everything when the server is another one than before: its versions say nothing about ours. */
  enterEpoch(epoch: number): void {
    if (epoch === this.#epoch) return;
    this.#epoch = epoch;
    this.#seq = 0;
    this.#complete = false;
    this.#tiles.clear();
    this.#tell('all');
  }

  /** What this device kept from before a reload: the server goes on from there if it is still the same run. */
  restore(epoch: number, seq: number, tiles: readonly Tile[]): void {
    this.enterEpoch(epoch);
    this.#seq = seq;
    for (const tile of tiles) this.#tiles.set(tileKey(tile.tx, tile.ty), tile);
    this.#tell('all');
  }

  /** Resolves when the frame's tiles are in. Tiles that do not decode are left as they were and counted. */
  async add(frame: TileFrame): Promise<{ readonly broken: number }> {
    this.enterEpoch(frame.epoch);
    const decoded = await Promise.allSettled(frame.tiles.map(decodeTile));
    if (frame.epoch !== this.#epoch) return { broken: 0 };
    const changed: Tile[] = [];
    let broken = 0;
    decoded.forEach((result, i) => {
      const { tx, ty, version } = frame.tiles[i]!;
      const key = tileKey(tx, ty);
      if (result.status === 'rejected') broken++;
      else if (version >= (this.#tiles.get(key)?.version ?? 0)) {
        const tile: Tile = { tx, ty, version, cells: result.value };
        this.#tiles.set(key, tile);
        changed.push(tile);
      }
    });
    // A broken tile is asked for again after a reconnect: the position stays before it.
    if (broken === 0) this.#seq = Math.max(this.#seq, frame.seq);
    if (frame.type === 'end_of_snapshot') this.#complete = true;
    if (changed.length > 0) this.#tell(changed);
    return { broken };
  }

  #tell(changed: readonly Tile[] | 'all'): void {
    for (const listener of this.#listeners) listener(changed);
  }
}
