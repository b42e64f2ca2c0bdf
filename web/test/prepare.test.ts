import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import type { Pictures } from '../src/ui/state/pictures';
import { Prepare } from '../src/ui/state/prepare.svelte';
import { settle } from './support/fake_surroundings';
import { openSession } from './support/open_session';
import { between, randomSource } from './support/random';

const reading = readFileSync(fileURLToPath(new URL('../../proto/examples/http_plan_read.json', import.meta.url)), 'utf8');

interface Server {
  /** Answers to come, by the end of the address; a string is a refusal. */
  answers: Record<string, () => string | object>;
  readonly asked: string[];
  readonly bodies: string[];
}

async function desk(shelf: { value: unknown } = { value: null }) {
  const server: Server = {
    answers: { '/api/plans': () => ({ plan_id: 'p1', width: 1000, height: 500, warnings: ['dark'] }), '/read': () => JSON.parse(reading) as object },
    asked: [],
    bodies: [],
  };
  const fetcher = ((address: string, init?: RequestInit) => {
    server.asked.push(address);
    server.bodies.push(typeof init?.body === 'string' ? init.body : '');
    const found = Object.entries(server.answers).find(([end]) => address.split('?')[0]!.endsWith(end));
    const answer = found?.[1]() ?? 'there is no such page';
    const isRefusal = typeof answer === 'string';
    const body = isRefusal ? { error: { code: 'invalid_argument', message: answer } } : answer;
    return Promise.resolve(new Response(JSON.stringify(body), { status: isRefusal ? 400 : 200 }));
  }) as typeof fetch;
  const page = await openSession({ fetcher });
  const pictures = { get: (url: string) => Promise.resolve({ url } as unknown as ImageBitmap) } as unknown as Pictures;
  const prepare = new Prepare(page.session, pictures, {
    load: () => Promise.resolve(shelf.value),
    save: (value) => Promise.resolve(void (shelf.value = structuredClone(value))),
  });
  return { page, prepare, server, shelf };
}
const photo = new Blob(['x'], { type: 'image/jpeg' });
const pdf = new Blob(['x'], { type: 'application/pdf' });

describe('a sheet with several drawings', () => {
  const twoFloors = (homography: readonly number[]) => ({
    ...(JSON.parse(reading) as object),
    homography,
    drawings: [
      { box: [0, 0, 300, 300], score: 1, chosen: true },
      { box: [400, 0, 700, 300], score: 0.8, chosen: false },
      { box: [450, 50, 500, 100], score: 0.1, chosen: false },
    ],
  });
  const kIdentity = [1, 0, 0, 0, 1, 0, 0, 0, 1];

  test('reads the one that is tapped, the smallest under the finger, for one tap that can be taken back', async () => {
    const { prepare, server } = await desk();
    server.answers['/read'] = () => twoFloors(kIdentity);
    await prepare.upload(photo);
    expect(await prepare.choosePlan([420, 20])).toBe(true);
    expect(JSON.parse(server.bodies.at(-1)!)).toEqual({ plan_at: [420, 20] });
    expect([prepare.taps, prepare.canUndo]).toEqual([1, true]);
  });
  test('keeps the corners of the sheet where they were given', async () => {
    const { prepare, server } = await desk();
    server.answers['/read'] = () => twoFloors([1, 0.1, 0, 0, 1, 0, 0, 0, 1]);
    await prepare.upload(photo);
    await prepare.choosePlan([420, 20]);
    expect(Object.keys(JSON.parse(server.bodies.at(-1)!) as object)).toEqual(['corners', 'plan_at']);
  });
  test('asks nothing where the finger meets no other drawing', async () => {
    const { prepare, server } = await desk();
    server.answers['/read'] = () => twoFloors(kIdentity);
    await prepare.upload(photo);
    expect(await prepare.choosePlan([100, 100])).toBe(false);
    expect(server.asked).toHaveLength(2);
  });
});

describe('a picture that is chosen', () => {
  test('is read at once: walls come before any question', async () => {
    const { prepare, server } = await desk();
    await prepare.upload(photo);
    expect(prepare.step).toBe('walls');
    expect(prepare.draft?.walls).toHaveLength(5);
    expect(prepare.warnings).toEqual(['dark', 'the legend covers part of the plan']);
    expect(server.asked).toEqual(['/api/plans', '/api/plans/p1/read']);
    expect(prepare.corners).toEqual([[0, 0], [799, 0], [799, 599], [0, 599]]);
    expect(prepare.busy).toBe('');
    expect([prepare.canUndo, prepare.taps]).toEqual([false, 0]);
  });
  test('that cannot be read stays as a picture whose corners can be dragged', async () => {
    const { prepare, server, page } = await desk();
    server.answers['/read'] = () => 'there are no walls in it';
    await prepare.upload(photo);
    expect(prepare.step).toBe('corners');
    expect(prepare.draft).toBeUndefined();
    expect(prepare.corners).toHaveLength(4);
    expect(page.log).toEqual(['warning: There are no walls in it']);
    server.answers['/read'] = () => JSON.parse(reading) as object;
    prepare.holdCorner(0, [7, 8]);
    prepare.letGo();
    await prepare.read(true);
    expect(JSON.parse(server.bodies.at(-1)!)).toMatchObject({ corners: [[7, 8], expect.anything(), expect.anything(), expect.anything()] });
    expect(prepare.step).toBe('walls');
  });
  test('that is refused leaves everything as it was', async () => {
    const { prepare, server, page } = await desk();
    await prepare.upload(photo);
    const before = prepare.draft;
    server.answers['/api/plans'] = () => 'more than 40 megapixels';
    await prepare.upload(photo);
    expect(prepare.draft).toBe(before);
    expect(page.log).toEqual(['warning: More than 40 megapixels']);
  });
  test('takes the place of the one before, whose steps cannot come back', async () => {
    const { prepare, server } = await desk();
    await prepare.upload(photo);
    prepare.drawWall([0, 0], [50, 50]);
    server.answers['/api/plans'] = () => ({ plan_id: 'p2', width: 10, height: 10 });
    await prepare.upload(photo);
    expect(prepare.source?.planId).toBe('p2');
    expect(prepare.canUndo).toBe(false);
  });
});

describe('the pages of a document', () => {
  test('are turned one by one; where there is none the one before stays, and the server\'s words are shown', async () => {
    const { prepare, server, page } = await desk();
    await prepare.upload(pdf);
    await prepare.turnPage(1);
    expect(prepare.pdf?.page).toBe(2);
    expect(server.asked.filter((address) => address.startsWith('/api/plans?'))).toEqual(['/api/plans?page=1', '/api/plans?page=2']);
    server.answers['/api/plans'] = () => 'this PDF has 2 pages';
    await prepare.turnPage(1);
    expect(prepare.pdf?.page).toBe(2);
    expect(page.log).toEqual(['warning: This PDF has 2 pages']);
    await prepare.turnPage(-1);
    expect(server.asked.at(-1)).toBe('/api/plans?page=1');
  });
  test('a photograph has none', async () => {
    const { prepare, server } = await desk();
    await prepare.upload(photo);
    const asked = server.asked.length;
    await prepare.turnPage(1);
    expect(prepare.pdf).toBeNull();
    expect(server.asked).toHaveLength(asked);
  });
});

describe('corrections', () => {
  test('a tap finds walls within reach only', async () => {
    const { prepare } = await desk();
    await prepare.upload(photo);
    expect(prepare.tapWall([300, 503], 10)).toBe(true);
    expect(prepare.draft?.walls[0]?.on).toBe(false);
    expect(prepare.tapWall([250, 300], 10)).toBe(false);
    expect(prepare.taps).toBe(1);
  });
  test('a drawn wall starts and ends where walls are', async () => {
    const { prepare } = await desk();
    await prepare.upload(photo);
    expect(prepare.snap([104, 497], 10)).toEqual([100, 500]);
    expect(prepare.snap([250, 505], 10)).toEqual([250, 500]);
    prepare.tapWall([300, 500], 5);
    expect(prepare.snap([250, 505], 10)).toEqual([250, 505]);
  });
  test('dragging is one step however often it moves, and none when it is broken off', async () => {
    const { prepare } = await desk();
    await prepare.upload(photo);
    for (let i = 0; i < 30; i++) prepare.holdCorner(1, [700 + i, i]);
    expect(prepare.corners[1]).toEqual([729, 29]);
    prepare.letGo();
    expect(prepare.taps).toBe(1);
    prepare.undo();
    expect(prepare.corners[1]).toEqual([799, 0]);
    prepare.holdStart([5, 5]);
    prepare.dropHeld();
    expect(prepare.start).toBeNull();
  });
  test('the robot looks where it is dragged to, with up being up', async () => {
    const { prepare } = await desk();
    await prepare.upload(photo);
    prepare.holdStart([100, 100]);
    prepare.turnStart([100, 50]);
    prepare.letGo();
    expect(prepare.start?.heading).toBeCloseTo(Math.PI / 2, 9);
    expect(prepare.start?.p).toEqual([100, 100]);
  });
  test('a scale needs two points and a sensible length; a third point begins again', async () => {
    const { prepare, page } = await desk();
    await prepare.upload(photo);
    prepare.setScale(5);
    prepare.tapScale([0, 0]);
    prepare.tapScale([400, 300]);
    for (const bad of [0, -1, NaN, Infinity]) prepare.setScale(bad);
    expect(page.log).toHaveLength(5);
    prepare.setScale(25);
    expect(prepare.draft?.metresPerPixel).toBeCloseTo(0.05, 9);
    prepare.tapScale([1, 1]);
    expect(prepare.scalePoints).toEqual([[1, 1]]);
  });
  test('any of them, taken back, leave the first reading', async () => {
    for (let seed = 1; seed <= 20; seed++) {
      const random = randomSource(seed);
      const { prepare } = await desk();
      await prepare.upload(photo);
      const before = prepare.draft;
      const point = (): [number, number] => [between(random, 0, 800), between(random, 0, 600)];
      for (let i = 0; i < 15; i++) {
        const choice = Math.floor(between(random, 0, 4));
        if (choice === 0) prepare.tapWall(point(), 200);
        else if (choice === 1) prepare.drawWall(point(), point());
        else if (choice === 2) prepare.nameOpening(0, 'window');
        else {
          prepare.holdStart(point());
          prepare.letGo();
        }
      }
      while (prepare.canUndo) prepare.undo();
      expect(prepare.draft).toBe(before);
      expect(prepare.start).toBeNull();
    }
  });
});

describe('what was prepared', () => {
  test('is there again after the page was loaded again, undo included', async () => {
    const first = await desk();
    await first.prepare.upload(photo);
    first.prepare.tapWall([300, 500], 5);
    first.prepare.holdStart([5, 6]);
    first.prepare.letGo();
    const { prepare } = await desk(first.shelf);
    await prepare.restore();
    expect(prepare.step).toBe('walls');
    expect(prepare.start?.p).toEqual([5, 6]);
    expect(prepare.rectified).toEqual({ url: first.prepare.draft?.rectified });
    prepare.undo();
    prepare.undo();
    expect(prepare.draft?.walls.every((wall) => wall.on)).toBe(true);
    expect(prepare.taps).toBe(4);
  });
  test('does not come back over a picture that was chosen in the meantime, nor after it was put away', async () => {
    const first = await desk();
    await first.prepare.upload(photo);
    const second = await desk(first.shelf);
    await second.prepare.upload(photo);
    const chosen = second.prepare.draft;
    await second.prepare.restore();
    expect(second.prepare.draft).toBe(chosen);
    second.prepare.discard();
    const third = await desk(second.shelf);
    await third.prepare.restore();
    expect(third.prepare.source).toBeNull();
  });
  test('put in use waits for the link, is sent once, and counts as sent only when the server has it', async () => {
    const { prepare, page } = await desk();
    await prepare.upload(photo);
    prepare.holdStart([5, 6]);
    prepare.letGo();
    const sending = prepare.send('robot2');
    await settle();
    expect(prepare.sent).toBe(false);
    await page.welcome();
    const [command] = page.commands() as { id: string; name: string; data: { layout: { walls: unknown[] } } }[];
    expect([command!.name, command!.data.layout.walls.length]).toEqual(['set_layout', 5]);
    await page.tell({ type: 'done', id: command!.id, seq: 1 });
    await sending;
    expect(prepare.sent).toBe(true);
    expect(page.commands().at(-1)).toMatchObject({ name: 'set_start', data: { robot: 'robot2', px: [5, 6] } });
    prepare.undo();
    expect(prepare.sent).toBe(false);
  });
  test('that the server refuses is not in use, and the robot is not moved', async () => {
    const { prepare, page } = await desk();
    await page.welcome();
    await prepare.upload(photo);
    const sending = prepare.send('robot1');
    await settle();
    const [command] = page.commands() as { id: string }[];
    await page.tell({ type: 'refused', id: command!.id, code: 'invalid_argument', message: 'a wall without length' });
    await sending;
    expect(prepare.sent).toBe(false);
    expect(page.log).toEqual(['warning: Plan put in use: a wall without length']);
    expect(page.commands()).toHaveLength(1);
  });
  test('with more walls than a message holds goes by HTTP', async () => {
    const { prepare, page, server } = await desk();
    await page.welcome();
    const walls = Array.from({ length: 2500 }, (_, i) => [i % 50, i / 50, (i % 50) + 100.123456, i / 50 + 100.123456, 4]);
    server.answers['/read'] = () => ({ ...(JSON.parse(reading) as object), walls, wall_confidence: [], wall_by_person: [], corners: [], wall_corners: [] });
    await prepare.upload(photo);
    server.answers['/api/commands'] = () => ({ type: 'done', id: 'x', seq: 3 });
    await prepare.send('robot1');
    expect(prepare.sent).toBe(true);
    expect(page.commands()).toEqual([]);
    expect(JSON.parse(server.bodies.at(-1)!)).toMatchObject({ type: 'command', name: 'set_layout' });
  });
});
