import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { deflateRawSync } from 'node:zlib';
import { describe, expect, test } from 'vitest';
import { mayCommand, timeToLive, type Command, type CommandName } from '../src/wire/commands';
import * as http from '../src/wire/http';
import { parseLayoutDocument, parseReadAnswer } from '../src/wire/layout_document';
import { encode, parseServerMessage } from '../src/wire/messages';
import { isPartName, parseTable, partNames } from '../src/wire/parts';
import { decodeTile, kTileCells, parseTileFrame, unpackCells } from '../src/wire/tile_frame';
import { apply, kEmptyWorld } from '../src/model/world';
import { randomSource } from './support/random';

const folder = fileURLToPath(new URL('../../proto/examples/', import.meta.url));
const names = readdirSync(folder);
const read = (name: string): unknown => JSON.parse(readFileSync(folder + name, 'utf8'));

describe('the examples that both sides parse', () => {
  test.each(names.filter((name) => name.startsWith('server_')))('%s is a message of the server', (name) => {
    expect(parseServerMessage(JSON.stringify(read(name)))).toBeDefined();
  });

  test.each(names.filter((name) => name.startsWith('server_delta')))('%s enters the world without a loss', (name) => {
    const message = parseServerMessage(JSON.stringify(read(name)));
    if (message?.type !== 'delta') throw new Error('not a delta');
    const applied = apply(kEmptyWorld, message);
    expect(applied).toMatchObject({ ok: true, dropped: 0 });
    if (applied.ok && isPartName(message.part)) expect(applied.world.tables[message.part].size).toBe(Object.keys(message.set).length);
  });

  test('every part that we know has an example, and every example a part', () => {
    const shown = new Set(names.flatMap((name) => /^server_delta_(.*)\.json$/.exec(name)?.[1] ?? []));
    shown.delete('info');
    shown.delete('info_no_plan');
    expect([...shown].sort()).toEqual([...partNames].sort());
  });

  const commands = names.filter((name) => name.startsWith('client_command_'));
  test.each(commands)('%s is a command that a commander may give', (name) => {
    const { type, id, name: word, data } = read(name) as { type: string; id: string; name: CommandName; data: never };
    expect(type).toBe('command');
    const command = { name: word, data } as Command;
    expect(mayCommand('commander', command)).toBe(true);
    expect(JSON.parse(encode({ type: 'command', id, ...command }))).toMatchObject({ id, name: word, data });
  });

  test('the answers of the HTTP side', () => {
    expect(http.parsePairing(read('http_pair.json'))?.role).toBe('commander');
    expect(http.parseUpload(read('http_plan.json'))?.width).toBeGreaterThan(0);
    expect(http.parseSketchPhoto(read('http_sketch_photo.json'))?.strokes).toHaveLength(1);
    expect(http.parseFailure(read('http_error.json'))?.error.code).toBe('too_large');
    expect(http.parseDone(read('http_command_answer.json'))?.seq).toBe(42);
    const page = http.parseEventPage(read('http_events.json'));
    expect(page?.events[0]).toMatchObject({ seq: 41, person: 'Anna', name: 'place_poi', outcome: 'done' });
    expect(page?.next).toBe(42);
  });

  test('layout documents, whole and minimal', () => {
    const whole = parseLayoutDocument(read('layout.json'));
    expect(whole?.walls).toHaveLength(5);
    expect(whole?.['homography']).toHaveLength(9);
    expect(parseLayoutDocument(read('layout_minimal.json'))?.wall_confidence).toEqual([]);
    expect(parseReadAnswer(read('http_plan_read.json'))?.rectified).toMatch(/^\/api\/plans\//);
    expect(parseReadAnswer(read('layout_minimal.json'))).toBeUndefined();
  });

  test('the map frame, cell by cell', async () => {
    const { hex, says } = read('map_frame.json') as { hex: string; says: { epoch: number; seq: number; server_ms: number } };
    const frame = parseTileFrame(Buffer.from(hex, 'hex'))!;
    expect(frame).toMatchObject({ type: 'tiles', layer: 0, epoch: says.epoch, seq: says.seq, serverMs: says.server_ms });
    expect(frame.tiles[0]).toMatchObject({ tx: -1, ty: 0, content: 5, version: 800 });
    expect(frame.tiles[1]).toMatchObject({ tx: 0, ty: 0, version: 812 });
    const cells = await decodeTile(frame.tiles[1]!);
    const expected = new Uint8Array(kTileCells * kTileCells);
    for (let row = 0; row < kTileCells; row++) {
      for (let column = 0; column < kTileCells; column++) expected[row * kTileCells + column] = column < 64 ? 1 : column === 64 ? 13 : 0;
    }
    expected[0] = 14;
    expected[expected.length - 1] = 15;
    expect(Buffer.from(cells).equals(Buffer.from(expected))).toBe(true);
  });

  test('the end of a snapshot', () => {
    const { hex } = read('map_frame_end_of_snapshot.json') as { hex: string };
    expect(parseTileFrame(Buffer.from(hex, 'hex'))).toMatchObject({ type: 'end_of_snapshot', tiles: [] });
  });
});

describe('what is not a message', () => {
  test.each(['', '[]', '{"type":"hello"}', '{"type":"done"}', '{"type":"pong","t":"x","server_ms":1}', '{', 'null'])('%j is dropped', (text) => {
    expect(parseServerMessage(text)).toBeUndefined();
  });
  test('an object that does not fit is left out, the others stay', () => {
    const { objects, dropped } = parseTable('links', { a: { p: [1, 2], corner: 0, state: 'kept' }, b: { p: [1], corner: 0, state: 'kept' }, c: 7 });
    expect([...objects.keys()]).toEqual(['a']);
    expect(dropped).toBe(2);
  });
});

describe('tile frames from nowhere', () => {
  const { hex } = read('map_frame.json') as { hex: string };
  const good = Buffer.from(hex, 'hex');
  test('cut anywhere they are refused', () => {
    for (let length = 0; length < good.length; length++) expect(parseTileFrame(good.subarray(0, length))).toBeUndefined();
    expect(parseTileFrame(Buffer.concat([good, Buffer.from([0])]))).toBeUndefined();
  });
  test('with any bytes changed they parse or are refused, and never throw', () => {
    const random = randomSource(12);
    for (let i = 0; i < 2000; i++) {
      const bytes = Buffer.from(good);
      for (let k = 0; k < 3; k++) bytes[Math.floor(random() * bytes.length)] = Math.floor(random() * 256);
      expect(() => parseTileFrame(bytes)).not.toThrow();
    }
  });
  test('that unpack to another size are refused', async () => {
    const tile = (bytes: Buffer) => ({ tx: 0, ty: 0, version: 1, content: new Uint8Array(deflateRawSync(bytes)) });
    await expect(decodeTile(tile(Buffer.alloc(8191)))).rejects.toThrow();
    await expect(decodeTile(tile(Buffer.alloc(8193)))).rejects.toThrow();
    await expect(decodeTile(tile(Buffer.alloc(2_000_000)))).rejects.toThrow();
    await expect(decodeTile({ tx: 0, ty: 0, version: 1, content: new Uint8Array([1, 2, 3]) })).rejects.toThrow();
  });
  test('low nibble first', () => {
    const packed = new Uint8Array(8192);
    packed[0] = 0x21;
    expect([...unpackCells(packed)!.subarray(0, 3)]).toEqual([1, 2, 0]);
    expect(unpackCells(new Uint8Array(10))).toBeUndefined();
  });
});

describe('who may do what', () => {
  const stop = (engaged: boolean): Command => ({ name: 'emergency_stop', data: { robot: '', engaged } });
  const goal: Command = { name: 'set_goal', data: { goal_id: 'g', robot: 'r', frame: 'map', p: [0, 0], heading: null } };
  const stroke: Command = { name: 'add_stroke', data: { stroke_id: 's', kind: 'wall', width: 3, points: [] } };
  test('everybody may stop, only a commander may release', () => {
    expect(mayCommand('observer', stop(true))).toBe(true);
    expect(mayCommand('firefighter', stop(false))).toBe(false);
    expect(mayCommand('commander', stop(false))).toBe(true);
  });
  test('a firefighter draws and marks but sends no robot; an observer does neither', () => {
    expect(mayCommand('firefighter', stroke)).toBe(true);
    expect(mayCommand('firefighter', goal)).toBe(false);
    expect(mayCommand('observer', stroke)).toBe(false);
  });
  test('drives and releases lapse; drawings and stops never do', () => {
    expect(timeToLive(goal)).toBe(5000);
    expect(timeToLive(stop(false))).toBe(5000);
    expect(timeToLive(stop(true))).toBeUndefined();
    expect(timeToLive(stroke)).toBeUndefined();
  });
});
