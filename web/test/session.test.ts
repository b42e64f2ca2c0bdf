import { describe, expect, test } from 'vitest';
import { restoreState } from '../src/model/saved';
import { kEmptyWorld } from '../src/model/world';
import type { Command } from '../src/wire/commands';
import { kTileCells } from '../src/wire/tile_frame';
import { settle } from './support/fake_surroundings';
import { openSession } from './support/open_session';
import { between, randomSource } from './support/random';

const stroke = (id: string): Command => ({ name: 'add_stroke', data: { stroke_id: id, kind: 'wall', width: 4, points: [[0, 0], [9, 9]] } });
const erase = (id: string, restore = false): Command => ({ name: 'erase_stroke', data: { stroke_id: id, restore } });
const told = (id: string) => ({ [id]: { kind: 'wall', author: 'Anna', width: 4, points: [[0, 0], [9, 9]] } });

describe('what the page knows', () => {
  test('follows the server, and one burst of changes is one change of the page', async () => {
    const { session, welcome, around } = await openSession();
    await welcome();
    let changes = 0;
    let last = session.world;
    const look = (): void => {
      if (session.world !== last) changes++;
      last = session.world;
    };
    for (let i = 0; i < 20; i++) around.socket.say({ type: 'delta', part: 'strokes', rev: i, set: told(`s${i}`) });
    look();
    await settle();
    await settle();
    look();
    expect(session.world.tables.strokes.size).toBe(20);
    expect(changes).toBeLessThanOrEqual(1);
  });

  test('after any sequence of breaks is what the server knows', async () => {
    for (let seed = 1; seed <= 25; seed++) {
      const random = randomSource(seed);
      const page = await openSession();
      await page.welcome();
      const truth = new Map<string, unknown>();
      let [rev, epoch] = [1, 7];
      for (let i = 0; i < 40; i++) {
        const choice = random();
        const id = `s${Math.floor(between(random, 0, 6))}`;
        if (choice < 0.5) {
          truth.set(id, told(id)[id]);
          await page.delta('strokes', told(id), { rev: rev++ });
        } else if (choice < 0.8) {
          truth.delete(id);
          await page.delta('strokes', {}, { rev: rev++, del: [id] });
        } else {
          // A restart of the server or of the link: after `welcome` each part comes whole.
          if (random() < 0.3) epoch++;
          await page.lose();
          await page.welcome(epoch);
          await page.delta('strokes', Object.fromEntries(truth), { rev: rev++, reset: true });
        }
      }
      expect([...page.session.world.tables.strokes.keys()].sort()).toEqual([...truth.keys()].sort());
    }
  });

  test('of another run of the server is forgotten at once', async () => {
    const page = await openSession();
    await page.welcome(7);
    await page.delta('strokes', told('a'));
    await page.lose();
    await page.welcome(8);
    expect(page.session.world.tables.strokes.size).toBe(0);
  });

  test('is offered to the server after a break, but not to another run of it', async () => {
    const page = await openSession();
    await page.welcome(7);
    await page.delta('strokes', told('a'), { rev: 12 });
    await page.lose();
    page.around.socket.onopen?.();
    expect(page.around.socket.sent[0]).toMatchObject({ type: 'hello', epoch: 7, parts: { strokes: 12 } });
  });
});

describe('what a person does', () => {
  test('shows at once, stays while the server carries it out, and is then the server\'s', async () => {
    const page = await openSession();
    await page.welcome();
    await page.session.send(stroke('a'));
    await page.around.pass(1);
    expect(page.session.world.tables.strokes.has('a')).toBe(true);
    expect(page.session.waiting).toBe(1);
    const [{ id }] = page.commands() as [{ id: string }];
    await page.tell({ type: 'done', id, seq: 1 });
    expect(page.session.world.tables.strokes.has('a')).toBe(true);
    await page.delta('strokes', told('a'));
    await page.around.pass(1_000);
    expect(page.session.waiting).toBe(0);
    expect(page.session.world.tables.strokes.get('a')?.author).toBe('Anna');
  });

  test('goes away again when the server refuses it, with the reason in words', async () => {
    const page = await openSession();
    await page.welcome();
    await page.session.send(stroke('a'));
    const [{ id }] = page.commands() as [{ id: string }];
    await page.tell({ type: 'refused', id, code: 'invalid_argument', message: 'too many points' });
    await page.around.pass(1_000);
    expect(page.session.world.tables.strokes.has('a')).toBe(false);
    expect(page.log).toEqual(['warning: Stroke drawn: too many points']);
  });

  test('that is acknowledged but never shown is not drawn as ours for ever', async () => {
    const page = await openSession();
    await page.welcome();
    await page.session.send(stroke('a'));
    const [{ id }] = page.commands() as [{ id: string }];
    await page.tell({ type: 'done', id, seq: 1 });
    await page.around.pass(2_000);
    expect(page.session.world.tables.strokes.has('a')).toBe(true);
    await page.around.pass(3_000);
    expect(page.session.world.tables.strokes.has('a')).toBe(false);
  });

  test('is taken back and done again by commands of its own, also without a link', async () => {
    const page = await openSession();
    page.session.act([stroke('a')], [erase('a')]);
    page.session.undo();
    page.session.redo();
    page.session.undo();
    page.session.undo();
    await page.around.pass(1);
    await page.welcome();
    const names = page.commands().map(({ name, data }) => [name, (data as { restore?: boolean }).restore]);
    expect(names).toEqual([['add_stroke', undefined], ['erase_stroke', false], ['add_stroke', undefined], ['erase_stroke', false]]);
    expect(page.session.history.done).toHaveLength(0);
    expect(page.session.history.undone).toHaveLength(1);
  });

  test('that the role does not allow is not sent, and the page says why not', async () => {
    const page = await openSession({ role: 'observer' });
    await page.welcome();
    expect(await page.session.send(stroke('a'))).toBe('');
    expect(page.commands()).toEqual([]);
    expect(page.session.whyNot('add_stroke')).toBe('Observers can look, and stop the robots.');
    expect((await openSession({ role: 'firefighter' })).session.whyNot('set_goal')).toBe('Only the commander can do this.');
    expect((await openSession()).session.whyNot('set_goal')).toBeUndefined();
  });

  test('and is waited for resolves with what the server says, however late', async () => {
    const page = await openSession();
    const first = page.session.sendAndWait(stroke('a'));
    const second = page.session.sendAndWait(stroke('b'));
    await page.around.pass(30_000);
    await page.welcome();
    const [a, b] = page.commands() as { id: string }[];
    await page.tell({ type: 'done', id: a!.id, seq: 1 });
    await page.tell({ type: 'refused', id: b!.id, code: 'conflict', message: 'no' });
    expect([await first, await second].map(({ ok }) => ok)).toEqual([true, false]);
  });
});

describe('the state of the link in words', () => {
  test('from connecting to live, slow, lost and back', async () => {
    const page = await openSession();
    const word = (): string => page.session.linkWord;
    await page.around.pass(600);
    expect(word()).toBe('connecting');
    await page.welcome();
    await page.around.pass(600);
    expect(word()).toBe('live');
    await page.around.pass(3_000);
    expect(word()).toBe('slow');
    await page.around.pass(8_000);
    expect(word()).toBe('lost');
    await page.welcome();
    await page.around.pass(600);
    expect(word()).toBe('live');
  });
  test('a device that was turned away hears of it', async () => {
    const page = await openSession();
    page.around.socket.onclose?.(4001);
    expect(page.log).toEqual(['unauthorised']);
  });
});

describe('a page that was loaded again', () => {
  const head = { format: 1, epoch: 7, seq: 42, revisions: { strokes: 12 }, resolutionM: 0.1, heardMs: 0, clockOffsetMs: 250 } as const;
  const cells = new Uint8Array(kTileCells * kTileCells).fill(3);
  const parts = { strokes: told('kept'), info: { floor: { stopped: true } } };
  const kept = (heardMs: number) => restoreState({ ...head, heardMs, parts, tiles: [{ tx: 1, ty: 2, version: 40, cells }] })!;

  test('shows the last state before there is a link, and says how old it is once it has tried', async () => {
    const page = await openSession({ kept: kept(1_000_000 - 60_000) });
    expect(page.session.world.tables.strokes.has('kept')).toBe(true);
    expect(page.session.world.floor?.stopped).toBe(true);
    expect(page.session.tiles.tiles.size).toBe(1);
    expect(page.session.resolutionM).toBe(0.1);
    expect(page.session.linkWord).toBe('connecting');
    await page.around.pass(2_000);
    expect(page.session.linkWord).toBe('lost');
    expect(page.session.linkAgeMs).toBeGreaterThanOrEqual(61_500);
    expect(page.session.serverNowMs).toBe(page.around.now + 250);
  });
  test('goes on from there when it is still the same run of the server', async () => {
    const page = await openSession({ kept: kept(999_000) });
    page.around.socket.onopen?.();
    expect(page.around.socket.sent[0]).toMatchObject({ epoch: 7, seq: 42, parts: { strokes: 12 } });
    await page.welcome(7);
    expect(page.session.world.tables.strokes.has('kept')).toBe(true);
  });
  test('forgets all of it when it is another run', async () => {
    const page = await openSession({ kept: kept(999_000) });
    await page.welcome(8);
    expect(page.session.world.tables.strokes.size).toBe(0);
    expect(page.session.tiles.tiles.size).toBe(0);
  });
  test('what it tells to keep is what it shows, and nothing before the server was heard', async () => {
    let [changes, acts] = [0, 0];
    const page = await openSession({ keeping: { changed: () => changes++, acted: () => acts++ } });
    expect(page.session.state).toBeUndefined();
    await page.welcome();
    await page.delta('strokes', told('a'), { rev: 5 });
    expect(restoreState(page.session.state)?.world).toEqual({ ...kEmptyWorld, revisions: { strokes: 5 }, tables: page.session.world.tables });
    expect(changes).toBeGreaterThan(0);
    await page.session.send(erase('a'));
    const [{ id }] = page.commands() as [{ id: string }];
    await page.tell({ type: 'done', id, seq: 2 });
    expect(acts).toBe(1);
  });
});

describe('looking around', () => {
  test('is told at most twice a second, leaving the map at once', async () => {
    const page = await openSession();
    await page.welcome();
    for (let i = 0; i < 10; i++) {
      page.session.looksAt([i, 0], 5);
      await page.around.pass(100);
    }
    expect(page.around.socket.of('view').length).toBeLessThanOrEqual(3);
    const before = page.around.socket.of('presence').length;
    page.session.looksAt(null);
    page.session.looksAt(null);
    expect(page.around.socket.of('presence').length).toBe(before + 2);
  });
});
