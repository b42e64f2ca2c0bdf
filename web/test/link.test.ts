import 'fake-indexeddb/auto';
import { describe, expect, test } from 'vitest';
import { backoffMs } from '../src/link/backoff';
import { IdbStorage } from '../src/link/idb_storage';
import { LiveLink, type LinkHandlers, type Position } from '../src/link/live_link';
import { type Entry, MemoryStorage, Outbox, type OutboxStorage } from '../src/link/outbox';
import { Api } from '../src/link/api';
import type { Command } from '../src/wire/commands';
import { FakeSurroundings, settle } from './support/fake_surroundings';
import { between, randomSource } from './support/random';

const kWelcome = { type: 'welcome', device: 'd', role: 'commander', name: 'Anna', epoch: 7, seq: 3, server_ms: 5_000_000 };
const poi: Command = { name: 'place_poi', data: { poi_id: 'p', kind: 'fire', frame: 'map', p: [1, 2], label: '' } };
const goal: Command = { name: 'set_goal', data: { goal_id: 'g', robot: 'r', frame: 'map', p: [1, 2], heading: null } };

async function start(storage: OutboxStorage = new MemoryStorage(), position: () => Position = () => ({ epoch: 0, seq: 0 })) {
  const world = new FakeSurroundings();
  const log: string[] = [];
  const drawn: (() => void)[] = [];
  const handlers: LinkHandlers = {
    welcome: () => log.push('welcome'),
    delta: ({ part }) => log.push(`delta ${part}`),
    tiles: () => new Promise((resolve) => drawn.push(resolve)),
    done: (entry) => log.push(`done ${entry.command.name}`),
    refused: (entry, why) => log.push(`refused ${entry.command.name}: ${why}`),
    expired: (entry) => log.push(`expired ${entry.command.name}`),
    ink: ({ stroke_id }) => log.push(`ink ${stroke_id}`),
    changed: () => {},
    unauthorised: () => log.push('unauthorised'),
  };
  const outbox = await Outbox.open(storage);
  const link = new LiveLink(world, handlers, outbox, 'secret', position);
  link.start();
  const welcome = async (): Promise<void> => {
    world.socket.onopen?.();
    world.socket.say({ ...kWelcome, server_ms: world.now + 4_000_000 });
    await settle();
  };
  return { world, log, drawn, link, outbox, welcome };
}

describe('the link', () => {
  test('says hello with its token and what it holds, and nothing before', async () => {
    const { world } = await start(new MemoryStorage(), () => ({ epoch: 7, seq: 42, parts: { walls: 3 } }));
    expect(world.socket.sent).toEqual([]);
    world.socket.onopen?.();
    expect(world.socket.sent).toEqual([{ type: 'hello', token: 'secret', version: 1, epoch: 7, seq: 42, parts: { walls: 3 } }]);
  });

  test('comes back by itself with growing pauses, and quickly when the network returns', async () => {
    const { world, link } = await start();
    world.socket.onclose?.(1006);
    await world.pass(499);
    expect(world.sockets).toHaveLength(1);
    await world.pass(1);
    expect(world.sockets).toHaveLength(2);
    world.socket.onclose?.(1006);
    await world.pass(600);
    expect(world.sockets).toHaveLength(2);
    link.hurry();
    expect(world.sockets).toHaveLength(3);
  });

  test('gives up a connection that has been silent for ten seconds', async () => {
    const { world, welcome } = await start();
    await welcome();
    await world.pass(9_000);
    expect(world.sockets).toHaveLength(1);
    expect(world.socket.of('ping').length).toBeGreaterThanOrEqual(9);
    await world.pass(2_000);
    expect(world.sockets[0]!.closed).toBe(true);
    expect(world.sockets).toHaveLength(2);
  });

  test('gives up a connection that never opens', async () => {
    const { world } = await start();
    await world.pass(10_600);
    expect(world.sockets).toHaveLength(2);
  });

  test('does not come back when the server does not know it', async () => {
    const { world, log } = await start();
    world.socket.onclose?.(4001);
    await world.pass(60_000);
    expect(world.sockets).toHaveLength(1);
    expect(log).toEqual(['unauthorised']);
  });

  test('returns a credit when the tiles were drawn, not before, and never to another connection', async () => {
    const { world, drawn, welcome } = await start();
    await welcome();
    const frame = Buffer.from('01010000780221692c03000000000000007090538faa79420000', 'hex');
    world.socket.onmessage?.(new Uint8Array(frame));
    await settle();
    expect(world.socket.of('ack')).toEqual([]);
    drawn[0]!();
    await settle();
    expect(world.socket.of('ack')).toEqual([{ type: 'ack', seq: 812 }]);
    world.socket.onmessage?.(new Uint8Array(frame));
    world.socket.onclose?.(1006);
    await world.pass(600);
    await welcome();
    drawn[1]!();
    await settle();
    expect(world.socket.of('ack')).toEqual([]);
  });

  test('counts what it does not understand and goes on', async () => {
    const { world, link, log, welcome } = await start();
    await welcome();
    world.socket.onmessage?.('{"type":"nonsense"}');
    world.socket.onmessage?.(new Uint8Array([9, 9, 9]));
    world.socket.say({ type: 'delta', part: 'walls', rev: 1 });
    expect(link.malformed).toBe(2);
    expect(log).toEqual(['welcome', 'delta walls']);
  });

  test('learns the clock of the server from the quickest exchange', async () => {
    const { world, link, welcome } = await start();
    await welcome();
    expect(link.serverNowMs()).toBe(5_000_000);
    const t = world.now;
    await world.pass(20);
    world.socket.say({ type: 'pong', t, server_ms: 5_000_110 });
    expect(link.serverNowMs()).toBe(5_000_120);
    await world.pass(500);
    world.socket.say({ type: 'pong', t, server_ms: 9_999_999 });
    expect(link.serverNowMs()).toBe(5_000_620);
  });
});

describe('what a person did', () => {
  test('is sent at once when there is a link', async () => {
    const { world, link, log, welcome } = await start();
    await welcome();
    const id = await link.send(poi);
    expect(world.socket.of('command')).toEqual([{ type: 'command', id, ...poi }]);
    world.socket.say({ type: 'done', id, seq: 9 });
    await settle();
    expect(log).toContain('done place_poi');
  });

  test('is sent again after every reconnect until the server answers, in order and under the same ids', async () => {
    const { world, link, outbox, welcome } = await start();
    const first = await link.send(poi);
    const second = await link.send({ name: 'remove_poi', data: { poi_id: 'p' } });
    await welcome();
    expect(world.socket.of('command').map((message) => message['id'])).toEqual([first, second]);
    world.socket.say({ type: 'done', id: first, seq: 1 });
    await settle();
    world.socket.onclose?.(1006);
    await world.pass(600);
    await welcome();
    expect(world.socket.of('command').map((message) => message['id'])).toEqual([second]);
    world.socket.say({ type: 'refused', id: second, code: 'not_found', message: 'no such mark' });
    await settle();
    expect(outbox.entries).toEqual([]);
  });

  test('a drive waits five seconds for a link, then lapses and says so; a mark waits for ever', async () => {
    const { world, link, log, welcome } = await start();
    await welcome();
    world.socket.onclose?.(1006);
    await link.send(goal);
    await link.send(poi);
    for (let i = 0; i < 10; i++) {
      await world.pass(1_000);
      world.socket.onclose?.(1006);
    }
    await world.pass(8_000);
    await welcome();
    await settle();
    expect(log).toContain('expired set_goal');
    expect(world.socket.of('command').map((message) => message['name'])).toEqual(['place_poi']);
  });

  test('carries the moment at which it lapses, by the clock of the server', async () => {
    const { world, link, welcome } = await start();
    await welcome();
    await link.send(goal);
    expect(world.socket.of('command')[0]).toMatchObject({ expires_ms: 5_005_000 });
  });

  test('does not wait for the disk when it is an emergency', async () => {
    const never: OutboxStorage = { all: () => Promise.resolve([]), put: () => new Promise(() => {}), remove: () => Promise.resolve() };
    const { world, link, welcome } = await start(never);
    await welcome();
    void link.send({ name: 'emergency_stop', data: { robot: '', engaged: true } });
    expect(world.socket.of('command')).toHaveLength(1);
  });

  test('survives the page: another one finds it on the disk and goes on counting', async () => {
    const storage = await IdbStorage.open('tablet');
    const before = await Outbox.open(storage);
    await before.add('one', poi, 1, null);
    await before.add('two', goal, 2, 99);
    const after = await Outbox.open(await IdbStorage.open('tablet'));
    expect(after.entries.map(({ id }) => id)).toEqual(['one', 'two']);
    expect((await after.add('three', poi, 3, null)).order).toBe(3);
    await after.settle('one');
    expect(await after.expire(98)).toEqual([]);
    expect((await after.expire(99)).map(({ id }: Entry) => id)).toEqual(['two']);
    expect((await Outbox.open(storage)).entries.map(({ id }) => id)).toEqual(['three']);
  });

  test('of one device is not sent by another', async () => {
    await (await Outbox.open(await IdbStorage.open('anna'))).add('hers', poi, 1, null);
    expect((await Outbox.open(await IdbStorage.open('bo'))).entries).toEqual([]);
  });
});

test('pauses before a retry stay between half a second and eight, and differ between tablets', () => {
  for (let attempt = 0; attempt < 20; attempt++) {
    for (const random of [0, 0.5, 0.999]) {
      expect(backoffMs(attempt, random)).toBeGreaterThanOrEqual(500);
      expect(backoffMs(attempt, random)).toBeLessThanOrEqual(8_000);
    }
  }
  expect(backoffMs(9, 0.1)).not.toBe(backoffMs(9, 0.9));
});

describe('the HTTP side', () => {
  const answering = (status: number, body: unknown, seen: Request[] = []): typeof fetch => (input, init) => {
    seen.push(new Request(new URL(String(input), 'http://test'), init));
    return Promise.resolve(new Response(JSON.stringify(body), { status }));
  };
  test('says what the server said when it refuses, and something useful when there is none', async () => {
    const refused = new Api(answering(413, { error: { code: 'too_large', message: 'too large' } }));
    expect(await refused.uploadPlan(new Blob(['x']))).toEqual({ ok: false, message: 'too large', status: 413 });
    const gone = new Api(() => Promise.reject(new TypeError('network')));
    expect(await gone.events(1, 10)).toMatchObject({ ok: false, message: 'no link to the server' });
    const odd = new Api(answering(200, { nothing: true }));
    expect(await odd.snapshot(3)).toMatchObject({ ok: false });
  });
  test('carries the token, and the page of a PDF', async () => {
    const seen: Request[] = [];
    const api = new Api(answering(200, { plan_id: 'p', width: 1, height: 1 }, seen));
    api.token = 'secret';
    await api.uploadPlan(new Blob(['x'], { type: 'application/pdf' }), 3);
    expect(seen[0]!.headers.get('Authorization')).toBe('Bearer secret');
    expect(seen[0]!.url).toBe('http://test/api/plans?page=3');
    await api.uploadPlan(new Blob(['x'], { type: 'application/pdf' }), 3, true);
    expect(seen[1]!.url).toBe('http://test/api/plans?page=3&patience=1');
  });
});

describe('a link that breaks again and again', () => {
  /** A server that keeps a log, carries out each id once, and whose answers may be lost with the connection. */
  function faultyServer(random: () => number) {
    const done = new Set<string>();
    const order: string[] = [];
    const take = (message: Record<string, unknown>): object | undefined => {
      if (message['type'] !== 'command') return undefined;
      const id = message['id'] as string;
      if (!done.has(id)) order.push(id);
      done.add(id);
      return random() < 0.6 ? { type: 'done', id, seq: order.length } : undefined;
    };
    return { order, take };
  }

  test('carries out every act once, in order, whatever is lost on the way', async () => {
    for (let seed = 1; seed <= 40; seed++) {
      const random = randomSource(seed);
      const { world, link, outbox } = await start();
      const server = faultyServer(random);
      const made: string[] = [];
      let answered = 0;
      const deliver = (): void => {
        const sent = world.socket.sent.slice(answered);
        answered = world.socket.sent.length;
        for (const message of sent) {
          const answer = server.take(message);
          if (answer) world.socket.say(answer);
        }
      };
      const reconnect = async (): Promise<void> => {
        world.socket.onclose?.(1006);
        await world.pass(8_000);
        answered = 0;
        world.socket.onopen?.();
        world.socket.say({ ...kWelcome, server_ms: world.now });
        await settle();
      };
      await reconnect();
      for (let i = 0; i < 12; i++) {
        made.push(await link.send({ name: 'place_poi', data: { poi_id: `p${i}`, kind: 'fire', frame: 'map', p: [i, seed], label: '' } }));
        if (random() < 0.7) deliver();
        await settle();
        if (random() < 0.3) await reconnect();
      }
      for (let i = 0; i < 30 && outbox.entries.length > 0; i++) {
        await reconnect();
        deliver();
        await settle();
      }
      expect(outbox.entries).toEqual([]);
      expect(server.order).toEqual(made);
    }
  });

  test('is not brought down by anything that a server may say', async () => {
    const random = randomSource(99);
    const { world, link, log, welcome } = await start();
    await welcome();
    const words = ['{', 'null', '[]', '{"type":7}', '{"type":"delta"}', '{"type":"delta","part":"walls","set":7}', '{"type":"done"}', '{"type":"pong","t":"x","server_ms":1}', '{"type":"ink","device":"a","stroke_id":"b","points":[[1]]}'];
    for (let i = 0; i < 300; i++) {
      if (random() < 0.5) world.socket.onmessage?.(words[Math.floor(between(random, 0, words.length))]!);
      else world.socket.onmessage?.(Uint8Array.from({ length: Math.floor(between(random, 0, 60)) }, () => Math.floor(between(random, 0, 256))));
    }
    expect(link.malformed).toBe(300);
    expect(link.connected).toBe(true);
    expect(log).toEqual(['welcome']);
  });

  test('knows the time of the server from before a reload until it is told better', async () => {
    const world = new FakeSurroundings();
    const outbox = await Outbox.open(new MemoryStorage());
    const nothing = (): void => {};
    const handlers = { welcome: nothing, delta: nothing, tiles: () => Promise.resolve(), done: nothing, refused: nothing, expired: nothing, ink: nothing, changed: nothing, unauthorised: nothing };
    const link = new LiveLink(world, handlers, outbox, 'secret', () => ({ epoch: 0, seq: 0 }), 4_321);
    expect(link.serverNowMs()).toBe(world.now + 4_321);
    link.start();
    world.socket.onopen?.();
    world.socket.say({ ...kWelcome, server_ms: world.now + 17 });
    expect(link.clockOffsetMs).toBe(17);
  });
});

describe('what is kept beside the outbox', () => {
  test('comes back by its name, and is gone when the device is turned away', async () => {
    const storage = await IdbStorage.open('keeps');
    expect(await storage.loadState('last')).toBeNull();
    await storage.saveState('last', { a: new Uint8Array([1, 2]) });
    await storage.saveState('preparation', { step: 3 });
    const again = await IdbStorage.open('keeps');
    expect(await again.loadState('last')).toEqual({ a: new Uint8Array([1, 2]) });
    expect(await again.loadState('preparation')).toEqual({ step: 3 });
    await again.forgetStates();
    expect(await storage.loadState('last')).toBeNull();
  });
});
