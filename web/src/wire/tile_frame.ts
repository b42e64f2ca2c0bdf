/**
 * Binary frames: tiles of the sensed map (docs/wire.md, "Map frames"). Little endian:
 *   u8 version = 1, u8 type (1 tiles, 2 end of snapshot), u16 layer, u32 epoch, u64 seq, f64 server ms, u16 count,
 *   then per tile  i16 tx, i16 ty, u8 encoding (0 uniform, 1 packed), u8 value, u32 tile version, u32 length, bytes.
 * The bytes of a packed tile are deflate-raw of 128 x 128 cells, two a byte, low nibble first, row 0 = lowest y.
 */
export const kTileCells = 128;
const kHeaderBytes = 26;
const kTileHeaderBytes = 14;
const kPackedBytes = (kTileCells * kTileCells) / 2;

export interface TileHeader {
  readonly tx: number;
  readonly ty: number;
  readonly version: number;
  /** The code of every cell, or the compressed cells. */
  readonly content: number | Uint8Array;
}

export interface TileFrame {
  readonly type: 'tiles' | 'end_of_snapshot';
  readonly layer: number;
  readonly epoch: number;
  readonly seq: number;
  readonly serverMs: number;
  readonly tiles: readonly TileHeader[];
}

/** undefined for anything that is not exactly one frame of this form: short, long, or of an unknown version or type. */
export function parseTileFrame(bytes: Uint8Array): TileFrame | undefined {
  if (bytes.byteLength < kHeaderBytes) return undefined;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const type = view.getUint8(1);
  if (view.getUint8(0) !== 1 || (type !== 1 && type !== 2)) return undefined;
  const seq = Number(view.getBigUint64(8, true));
  const count = view.getUint16(24, true);
  const tiles: TileHeader[] = [];
  let at = kHeaderBytes;
  for (let i = 0; i < count; i++) {
    const tile = parseTile(view, bytes, at);
    if (!tile) return undefined;
    tiles.push(tile.header);
    at = tile.next;
  }
  if (at !== bytes.byteLength) return undefined;
  return {
    type: type === 1 ? 'tiles' : 'end_of_snapshot',
    layer: view.getUint16(2, true),
    epoch: view.getUint32(4, true),
    seq,
    serverMs: view.getFloat64(16, true),
    tiles,
  };
}

function parseTile(view: DataView, bytes: Uint8Array, at: number): { header: TileHeader; next: number } | undefined {
  const body = at + kTileHeaderBytes;
  if (body > bytes.byteLength) return undefined;
  const encoding = view.getUint8(at + 4);
  const value = view.getUint8(at + 5);
  const next = body + view.getUint32(at + 10, true);
  if (next > bytes.byteLength || encoding > 1 || (encoding === 0 && value > 15)) return undefined;
  const header: TileHeader = {
    tx: view.getInt16(at, true),
    ty: view.getInt16(at + 2, true),
    version: view.getUint32(at + 6, true),
    content: encoding === 0 ? value : bytes.subarray(body, next),
  };
  return { header, next };
}

/** One code (0..15) per cell, row 0 = lowest y; undefined when the bytes hold another number of cells. */
export function unpackCells(packed: Uint8Array): Uint8Array | undefined {
  if (packed.byteLength !== kPackedBytes) return undefined;
  const cells = new Uint8Array(kTileCells * kTileCells);
  for (let i = 0; i < packed.byteLength; i++) {
    const byte = packed[i]!;
    cells[2 * i] = byte & 15;
    cells[2 * i + 1] = byte >> 4;
  }
  return cells;
}

/**
 * The cells of one tile. Rejects when the bytes are not deflate-raw of a whole tile.
 * The browser's own decompressor runs off the main thread, so a burst of tiles does not hold up a gesture.
 */
export async function decodeTile(tile: TileHeader): Promise<Uint8Array> {
  if (typeof tile.content === 'number') return new Uint8Array(kTileCells * kTileCells).fill(tile.content);
  const cells = unpackCells(await inflate(tile.content, kPackedBytes));
  if (!cells) throw new Error(`tile ${tile.tx},${tile.ty} does not hold ${kTileCells} x ${kTileCells} cells`);
  return cells;
}

/** Stops reading beyond `limit` bytes: a few bytes can claim to hold very many. */
async function inflate(bytes: Uint8Array, limit: number): Promise<Uint8Array> {
  const stream = new DecompressionStream('deflate-raw');
  const writer = stream.writable.getWriter();
  // What is wrong with the bytes shows at the reading end.
  writer.write(bytes as BufferSource).catch(() => {});
  writer.close().catch(() => {});
  const reader = stream.readable.getReader();
  const out = new Uint8Array(limit);
  let length = 0;
  for (let chunk = await reader.read(); !chunk.done; chunk = await reader.read()) {
    if (length + chunk.value.byteLength > limit) {
      await reader.cancel();
      throw new Error('a tile holds more than its cells');
    }
    out.set(chunk.value, length);
    length += chunk.value.byteLength;
  }
  return out.subarray(0, length);
}
