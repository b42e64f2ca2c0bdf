// A small building, a robot that drives through it, and what it has seen: enough to work on the page without a server.
import { deflateRawSync } from 'node:zlib';

export const kTile = 128;
export const kCell = 0.05;
const kPixelsPerMetre = 25;
const kOffset = { x: 60, y: 60 };
const kSize = { width: 1120, height: 620 };

// Metres, y up. The plan is drawn 6 % too wide on the right wing, shows one wall that is gone, and lacks one that is there.
const kOutline = [
  [0, 0, 40, 0], [40, 0, 40, 20], [40, 20, 0, 20], [0, 20, 0, 0],
];
const kInner = [
  [0, 8, 6, 8], [8, 8, 16, 8], [18, 8, 26, 8], [28, 8, 40, 8],
  [0, 12, 10, 12], [12, 12, 22, 12], [24, 12, 34, 12], [36, 12, 40, 12],
  [8, 0, 8, 8], [16, 0, 16, 8], [24, 0, 24, 8], [32, 0, 32, 8],
  [10, 12, 10, 20], [20, 12, 20, 20], [30, 12, 30, 20],
];
const kGone = [24, 0, 24, 8];
const kNew = [36, 12, 36, 16];
const same = (a, b) => a.every((value, i) => value === b[i]);
export const realWalls = [...kOutline, ...kInner.filter((wall) => !same(wall, kGone)), kNew];
export const planWalls = [...kOutline, ...kInner];
const stretch = (x) => (x > 20 ? 20 + (x - 20) * 1.06 : x);
export const toPx = ([x, y]) => [kOffset.x + stretch(x) * kPixelsPerMetre, kSize.height - kOffset.y - y * kPixelsPerMetre];
export const planSize = [kSize.width, kSize.height];

export function layoutDocument(planId) {
  const walls = planWalls.map(([x1, y1, x2, y2]) => [...toPx([x1, y1]), ...toPx([x2, y2]), 5]);
  return {
    size: planSize,
    walls,
    wall_confidence: walls.map((_, i) => (i % 7 === 5 ? 0.35 : 0.92)),
    doors: [[...toPx([6, 8]), ...toPx([8, 8])], [...toPx([16, 8]), ...toPx([18, 8])], [...toPx([10, 12]), ...toPx([12, 12])]],
    corners: [],
    wall_corners: [],
    metres_per_pixel: 1 / kPixelsPerMetre,
    sheet_corners: [[20, 20], [kSize.width - 20, 20], [kSize.width - 20, kSize.height - 20], [20, kSize.height - 20]],
    warnings: ['a legend covers part of the sheet'],
    rectified: `/api/plans/${planId}/rectified?v=1`,
  };
}

export function planSvg() {
  const lines = planWalls
    .map(([x1, y1, x2, y2]) => {
      const [a, b] = [toPx([x1, y1]), toPx([x2, y2])];
      return `<line x1="${a[0]}" y1="${a[1]}" x2="${b[0]}" y2="${b[1]}"/>`;
    })
    .join('');
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${kSize.width}" height="${kSize.height}"><rect width="100%" height="100%" fill="#fbfaf5"/><g stroke="#222" stroke-width="5">${lines}</g><g fill="#1a8f4b"><rect x="70" y="300" width="26" height="20"/><rect x="980" y="300" width="26" height="20"/></g><text x="60" y="42" font-family="sans-serif" font-size="22" fill="#222">Flucht- und Rettungsplan, 1. OG</text></svg>`;
}

export const planRegions = () => {
  const rooms = [[0, 0, 8, 8], [8, 0, 16, 8], [16, 0, 24, 8], [24, 0, 32, 8], [32, 0, 40, 8], [0, 12, 10, 20], [10, 12, 20, 20], [20, 12, 30, 20], [30, 12, 40, 20], [0, 8, 40, 12]];
  return Object.fromEntries(
    rooms.map(([x1, y1, x2, y2], i) => [
      String(i + 1),
      { outline: [[x1, y1], [x2, y1], [x2, y2], [x1, y2]].map(toPx), kind: i === 9 ? 'corridor' : 'room' },
    ]),
  );
};

const kRoute = [[2, 10], [17, 10], [17, 4], [17, 10], [11, 10], [11, 15], [11, 10], [27, 10], [27, 4], [27, 10], [35, 10], [35, 16], [35, 10], [2, 10]];

export class FakeRobot {
  travelled = 0;
  x = 2;
  y = 10;
  heading = 0;
  advance(metres) {
    this.travelled += metres;
    let left = this.travelled;
    for (let i = 0; i + 1 < kRoute.length; i++) {
      const [a, b] = [kRoute[i], kRoute[i + 1]];
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (left > length) {
        left -= length;
        continue;
      }
      this.x = a[0] + ((b[0] - a[0]) * left) / length;
      this.y = a[1] + ((b[1] - a[1]) * left) / length;
      this.heading = Math.atan2(b[1] - a[1], b[0] - a[0]);
      return;
    }
    this.travelled = 0;
  }
}

const cross = (ax, ay, bx, by) => ax * by - ay * bx;

function range(x, y, angle, limit) {
  const [dx, dy] = [Math.cos(angle), Math.sin(angle)];
  let best = limit;
  for (const [x1, y1, x2, y2] of realWalls) {
    const [ex, ey] = [x2 - x1, y2 - y1];
    const determinant = cross(dx, dy, ex, ey);
    if (Math.abs(determinant) < 1e-9) continue;
    const t = cross(x1 - x, y1 - y, ex, ey) / determinant;
    const u = cross(x1 - x, y1 - y, dx, dy) / determinant;
    if (t > 0 && u >= 0 && u <= 1 && t < best) best = t;
  }
  return best;
}

export class FakeGrid {
  tiles = new Map();
  seen = new Set();
  #set(x, y, code) {
    const [cx, cy] = [Math.floor(x / kCell), Math.floor(y / kCell)];
    const [tx, ty] = [Math.floor(cx / kTile), Math.floor(cy / kTile)];
    const key = `${tx},${ty}`;
    if (!this.tiles.has(key)) this.tiles.set(key, { tx, ty, cells: new Uint8Array(kTile * kTile), version: 0, dirty: true });
    const tile = this.tiles.get(key);
    const at = (cy - ty * kTile) * kTile + (cx - tx * kTile);
    const before = tile.cells[at];
    const next = code === 13 ? Math.max(7, Math.min(13, before + 2)) : before === 0 || before > 6 ? (before > 9 ? before : 4) : Math.max(1, before - 1);
    if (next !== before) {
      tile.cells[at] = next;
      tile.dirty = true;
    }
  }
  scan(x, y) {
    for (let i = 0; i < 540; i++) {
      const angle = (i / 540) * 2 * Math.PI;
      const reach = range(x, y, angle, 8);
      for (let r = 0; r < reach - kCell; r += kCell) this.#set(x + r * Math.cos(angle), y + r * Math.sin(angle), 1);
      if (reach < 8) this.#set(x + reach * Math.cos(angle), y + reach * Math.sin(angle), 13);
    }
    realWalls.concat([kGone]).forEach((wall) => {
      const [mx, my] = [(wall[0] + wall[2]) / 2, (wall[1] + wall[3]) / 2];
      if (Math.hypot(mx - x, my - y) < 9) this.seen.add(wall.join());
    });
  }
}

/** One binary frame; see docs/wire.md, "Map frames". */
export function tileFrame(epoch, seq, tiles, type = 1) {
  const bodies = tiles.map(({ cells }) => {
    const packed = Buffer.alloc((kTile * kTile) / 2);
    for (let i = 0; i < packed.length; i++) packed[i] = cells[2 * i] | (cells[2 * i + 1] << 4);
    return deflateRawSync(packed);
  });
  const header = Buffer.alloc(26);
  header.writeUInt8(1, 0);
  header.writeUInt8(type, 1);
  header.writeUInt32LE(epoch, 4);
  header.writeBigUInt64LE(BigInt(seq), 8);
  header.writeDoubleLE(Date.now(), 16);
  header.writeUInt16LE(tiles.length, 24);
  const parts = [header];
  tiles.forEach(({ tx, ty, version }, i) => {
    const head = Buffer.alloc(14);
    head.writeInt16LE(tx, 0);
    head.writeInt16LE(ty, 2);
    head.writeUInt8(1, 4);
    head.writeUInt32LE(version, 6);
    head.writeUInt32LE(bodies[i].length, 10);
    parts.push(head, bodies[i]);
  });
  return Buffer.concat(parts);
}

export function wallTable(seen) {
  const table = {};
  planWalls.forEach((wall, i) => {
    const known = seen.has(wall.join());
    const moved = stretch(wall[0]) !== wall[0];
    const state = !known ? 'unseen' : same(wall, kGone) ? 'missing' : moved ? 'moved' : 'confirmed';
    table[`w${i}`] = { a: [wall[0], wall[1]], b: [wall[2], wall[3]], state, confidence: 0.9, moved_m: moved ? (wall[0] - 20) * 0.06 : 0.03 };
  });
  if (seen.has(kNew.join())) table.n0 = { a: [kNew[0], kNew[1]], b: [kNew[2], kNew[3]], state: 'new', confidence: 0.8, moved_m: 0 };
  return table;
}

export function planMesh() {
  const [xs, ys] = [[-2, 20, 42], [-2, 22]];
  const map = xs.flatMap((x) => ys.map((y) => [x, y]));
  return { map, px: map.map(toPx), triangles: [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]] };
}
