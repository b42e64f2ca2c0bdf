// A stand-in for `smokemap serve --demo` while working on the page: the same protocol, an invented world.
//   npm run build && node dev/fake_server.mjs [port]
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { WebSocketServer } from 'ws';
import { FakeGrid, FakeRobot, layoutDocument, planMesh, planRegions, planSize, planSvg, tileFrame, wallTable } from './fake_world.mjs';

const dist = fileURLToPath(new URL('../dist/', import.meta.url));
const port = Number(process.argv[2] ?? 8090);
const epoch = Math.floor(Date.now() / 1000);
const planId = 'a'.repeat(64);
const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.webmanifest': 'application/manifest+json' };
const csp = "default-src 'self'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob:; object-src 'none'; base-uri 'none'; frame-ancestors 'none'";

const robot = new FakeRobot();
const grid = new FakeGrid();
const parts = {
  info: {
    floor: { plan_id: planId, picture: `/api/plans/${planId}/rectified`, size: planSize, metres_per_pixel: 0.04, fit: { score: 0.86, verdict: 'fits' }, revision: 1, grid_bounds: [0, 0, 40, 20], exploring: true, stopped: false },
    plan_mesh: planMesh(),
    plan_nodes: planMesh(),
    sketch: { size: [1024, 768], warning: '' },
  },
  layout_walls: Object.fromEntries(layoutDocument(planId).walls.map((w, i) => [String(i), { px: w.slice(0, 4), confidence: i % 7 === 5 ? 0.35 : 0.9 }])),
  walls: {}, links: {}, robots: {}, goals: {}, people: {},
  alerts: { 'sketch-no-fit': { text: 'The sketch does not seem to show the building of the plan.', urgent: false } },
  anchors: { a1: { px: [500, 250], map: [20, 10], off_m: 1.4, outlier: true } },
  pois: {
    p1: { kind: 'gas_bottle', label: 'Acetylene, 2 bottles', author: 'Bo', created_ms: Date.now() - 95000, frame: 'layout_px', p: [300, 400], map: [12, 4], sigma_m: 0.2, confidence: 0.95, reason: '', removed: false },
    p2: { kind: 'victim', label: 'Seen at window', author: 'Anna', created_ms: Date.now() - 30000, frame: 'sketch_px', p: [640, 220], map: [27, 16], sigma_m: 1.6, confidence: 0.7, reason: '', removed: false },
    p3: { kind: 'exit', label: '', author: 'Anna', created_ms: Date.now() - 300000, frame: 'map', p: [0, 10], map: [0.2, 10], sigma_m: 0, confidence: 1, reason: '', removed: false },
    p4: { kind: 'shut_off', label: 'Main gas valve', author: 'Carl', created_ms: Date.now() - 200000, frame: 'sketch_px', p: [860, 560], map: null, sigma_m: 0, confidence: 0, reason: 'This room of the sketch has no counterpart on the plan yet.', removed: false },
  },
  strokes: {},
  sketch_regions: {}, sketch_gaps: {},
  plan_regions: planRegions(),
  pairs: {}, match: { match: { doubtful: true, margin: 0.1, next_pin: 3 } },
};
const box = (x1, y1, x2, y2) => [[x1, y1], [x2, y1 + 3], [x2 - 2, y2], [x1 + 2, y2 + 2], [x1, y1]];
const rooms = [[120, 420, 260, 600], [260, 420, 420, 600], [420, 420, 580, 600], [580, 420, 740, 600], [120, 120, 340, 300], [340, 120, 560, 300], [560, 120, 880, 300]];
rooms.forEach(([x1, y1, x2, y2], i) => {
  parts.strokes[`s${i}`] = { kind: 'wall', author: 'Bo', width: 4, points: box(x1, y1, x2, y2) };
  parts.sketch_regions[String(i + 1)] = { outline: [[x1, y1], [x2, y1], [x2, y2], [x1, y2]], kind: 'room', pair: [1, 2, 3, 5, 6, 7, 9][i], confidence: [0.92, 0.85, 0.4, 0.6, 0.9, 0.55, 0.83][i] };
  parts.pairs[`${i + 1}-${[1, 2, 3, 5, 6, 7, 9][i]}`] = { sketch: i + 1, plan: [1, 2, 3, 5, 6, 7, 9][i], confidence: [0.92, 0.85, 0.4, 0.6, 0.9, 0.55, 0.83][i], verdict: i === 0 ? 'confirmed' : 'proposed' };
});
parts.strokes.open = { kind: 'wall', author: 'Bo', width: 4, points: [[740, 420], [880, 424], [882, 600], [790, 602]] };
parts.sketch_gaps.g = { a: [740, 600], b: [790, 602], closed: false };
const log = [];
const clients = new Set();
let seq = 0;

const delta = (part, set, del = [], reset = false) => JSON.stringify({ type: 'delta', part, rev: ++seq, reset, set, del });
const tell = (message) => clients.forEach((client) => client.send(message));
function change(part, id, object) {
  if (object === null) delete parts[part][id];
  else parts[part][id] = object;
  tell(delta(part, object === null ? {} : { [id]: object }, object === null ? [id] : []));
}

const acts = {
  add_stroke: (d, who) => change('strokes', d.stroke_id, { kind: d.kind, author: who.name, width: d.width, points: d.points }),
  erase_stroke: (d) => !d.restore && change('strokes', d.stroke_id, null),
  place_poi: (d, who) => change('pois', d.poi_id, { ...d, author: who.name, created_ms: Date.now(), map: d.frame === 'map' ? d.p : null, sigma_m: 0, confidence: 1, reason: d.frame === 'map' ? '' : 'no counterpart yet', removed: false }),
  remove_poi: (d) => change('pois', d.poi_id, null),
  set_goal: (d, who) => change('goals', d.goal_id, { ...d, author: who.name, created_ms: Date.now(), map: d.p, sigma_m: 0, state: 'driving', reason: '', remaining_m: 12.4, eta_s: 31 }),
  cancel_goal: (d) => change('goals', d.goal_id, { ...parts.goals[d.goal_id], state: 'cancelled' }),
  emergency_stop: (d) => change('info', 'floor', { ...parts.info.floor, stopped: d.engaged }),
  set_exploring: (d) => change('info', 'floor', { ...parts.info.floor, exploring: d.exploring }),
  judge_pair: () => {},
};

function command(message, who) {
  log.push({ seq: log.length + 1, time_ms: Date.now(), device: who.device, person: who.name, role: who.role, id: message.id, name: message.name, data: message.data, outcome: 'done' });
  acts[message.name]?.(message.data, who);
  return { type: 'done', id: message.id, seq: log.length };
}

const me = { token: 'fake', device: 'd-fake', role: 'commander', name: 'Anna' };
const routes = {
  'POST /api/pair': (body) => ({ ...me, role: body.role ?? 'commander', name: body.name ?? 'Anna' }),
  'POST /api/plans': () => ({ plan_id: planId, width: planSize[0], height: planSize[1], warnings: [] }),
  [`POST /api/plans/${planId}/read`]: () => layoutDocument(planId),
  'POST /api/commands': (body) => command(body, me),
  'GET /api/way': () => ({ path: [[robot.x, robot.y], [35, 10], [35, 4]], length_m: 21.5, unseen_m: 12, reason: '' }),
  'GET /api/events': () => ({ events: log, next: log.length + 1 }),
  'GET /api/snapshot': () => ({ at: log.length, parts }),
};

const server = createServer((request, response) => {
  const url = new URL(request.url, 'http://localhost');
  const chunks = [];
  request.on('data', (chunk) => chunks.push(chunk));
  request.on('end', () => {
    response.setHeader('Content-Security-Policy', csp);
    const route = routes[`${request.method} ${url.pathname}`];
    if (route) {
      let body = {};
      try {
        body = JSON.parse(Buffer.concat(chunks).toString());
      } catch {}
      response.setHeader('Content-Type', 'application/json');
      return response.end(JSON.stringify(route(body)));
    }
    if (/^\/api\/plans\/.*\/(rectified|picture)$/.test(url.pathname)) {
      if (picture) {
        response.setHeader('Content-Type', 'image/png');
        return response.end(picture);
      }
      response.setHeader('Content-Type', 'image/svg+xml');
      return response.end(planSvg());
    }
    const file = normalize(join(dist, url.pathname));
    const found = file.startsWith(dist) && existsSync(file) && statSync(file).isFile() ? file : join(dist, 'index.html');
    response.setHeader('Content-Type', types[extname(found)] ?? 'application/octet-stream');
    createReadStream(found).pipe(response);
  });
});
// createImageBitmap does not take SVG: a PNG of the plan may be handed in.
import { readFileSync } from 'node:fs';
const picture = process.argv[3] ? readFileSync(process.argv[3]) : null;

const sockets = new WebSocketServer({ server, path: '/api/live', handleProtocols: () => 'smokemap.v1' });
sockets.on('connection', (socket) => {
  socket.on('message', (bytes) => {
    const message = JSON.parse(bytes.toString());
    if (message.type === 'hello') {
      clients.add(socket);
      socket.send(JSON.stringify({ type: 'welcome', device: me.device, role: me.role, name: me.name, epoch, seq: 1, server_ms: Date.now(), tile_size: 128, resolution_m: 0.05 }));
      for (const [part, table] of Object.entries(parts)) socket.send(delta(part, table, [], true));
      socket.send(tileFrame(epoch, seq, [...grid.tiles.values()]));
      socket.send(tileFrame(epoch, seq, [], 2));
    } else if (message.type === 'ping') socket.send(JSON.stringify({ type: 'pong', t: message.t, server_ms: Date.now() }));
    else if (message.type === 'command') socket.send(JSON.stringify(command(message, me)));
    else if (message.type === 'presence') change('people', me.device, { name: me.name, role: me.role, mode: message.mode, p: message.p, seen_ms: Date.now() });
  });
  socket.on('close', () => clients.delete(socket));
});

change('people', 'd-bo', { name: 'Bo', role: 'firefighter', mode: 'operate', p: [20, 6], seen_ms: Date.now() });
for (let i = 0; i < 90; i++) {
  robot.advance(0.5);
  grid.scan(robot.x, robot.y);
}
change('goals', 'g1', { robot: 'robot1', author: 'Anna', created_ms: Date.now() - 8000, frame: 'map', p: [35, 4], heading: 1.57, map: [35, 4], sigma_m: 0.2, state: 'driving', reason: '', remaining_m: 9.8, eta_s: 24 });
change('goals', 'g0', { robot: 'robot1', author: 'Anna', created_ms: Date.now() - 80000, frame: 'map', p: [44, 4], heading: null, map: [44, 4], sigma_m: 0.2, state: 'refused', reason: 'There is no way there.', remaining_m: null, eta_s: null });
setInterval(() => {
  if (!parts.info.floor.stopped) robot.advance(0.08);
  grid.scan(robot.x, robot.y);
  for (const tile of grid.tiles.values()) if (tile.dirty) tile.version = seq + 1;
  const dirty = [...grid.tiles.values()].filter((tile) => tile.dirty);
  dirty.forEach((tile) => (tile.dirty = false));
  seq++;
  if (dirty.length) tell(tileFrame(epoch, seq, dirty));
  change('robots', 'robot1', { x: robot.x, y: robot.y, heading: robot.heading, sigma_m: 0.12, sigma_rad: 0.03, localized: true, link: 'fresh', heard_ms: Date.now(), speed: 0.4, stopped: parts.info.floor.stopped, exploring: parts.info.floor.exploring, goal: 'g1', path: [[robot.x, robot.y], [33, 10], [35, 10], [35, 4]], note: '' });
  if (seq % 5 === 0) {
    const walls = wallTable(grid.seen);
    Object.assign(parts.walls, walls);
    tell(delta('walls', walls));
  }
}, 200);
parts.walls = wallTable(grid.seen);
// FAKE_WALLS=5000: as many walls as a large building has, to measure what a frame costs.
const kMany = Number(process.env.FAKE_WALLS ?? 0);
const kStates = ['confirmed', 'moved', 'unseen', 'missing', 'new'];
for (let i = 0; i < kMany; i++) {
  const [x, y] = [(i % 100) * 0.4, Math.floor(i / 100) * 0.4];
  parts.walls[`n${1000 + i}`] = { a: [x, y], b: i % 2 ? [x + 0.35, y] : [x, y + 0.35], state: kStates[i % 5], confidence: 0.8, moved_m: 0 };
}
server.listen(port, '127.0.0.1', () => console.log(`http://127.0.0.1:${server.address().port}/`));
