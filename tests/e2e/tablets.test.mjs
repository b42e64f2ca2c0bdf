// The real server with the demo, and real browsers: what people do on tablets, and what happens when things break.
import assert from 'node:assert/strict';
import { after, afterEach, before, describe, test } from 'node:test';
import { Probe } from './support/probe.mjs';
import { Smokemap } from './support/smokemap.mjs';
import { openBrowser, Tablet } from './support/tablet.mjs';

const kLookAround = 120_000;
const kDrive = 300_000;

describe('tablets and the demo', { timeout: 900_000 }, () => {
  let browser;
  let smokemap;
  let tablets = [];
  const tablet = async () => {
    const opened = await Tablet.open(browser, smokemap.url);
    tablets.push(opened);
    return opened;
  };

  before(async () => {
    browser = await openBrowser();
    smokemap = new Smokemap();
    await smokemap.start();
  });
  after(async () => {
    await browser?.close();
    await smokemap?.dispose();
  });
  afterEach(async () => {
    const errors = tablets.flatMap(({ errors }) => errors);
    await Promise.all(tablets.map((opened) => opened.close()));
    tablets = [];
    assert.deepEqual(errors, []);
  });

  test('the live map comes by itself, with a robot and walls', async () => {
    const anna = await tablet();
    const probe = await Probe.open(smokemap.url);
    await probe.until(({ walls }) => Object.values(walls ?? {}).some(({ state }) => state !== 'unseen'), kLookAround);
    await anna.see('confirmed');
    await anna.page.waitForSelector('.chip.robot');
    probe.close();
  });

  test('closed lines become rooms', async () => {
    const bo = await tablet();
    await bo.mode('Sketch');
    await bo.draw([[0.3, 0.3], [0.5, 0.3], [0.5, 0.6], [0.3, 0.6], [0.3, 0.3]]);
    await bo.page.waitForSelector('li:has-text("Room")');
    await bo.page.click('.rail >> text=Undo');
    await bo.page.waitForSelector('li:has-text("Room")', { state: 'detached' });
  });

  test('a mark survives a server that is killed, and the page comes back without being loaded again', async () => {
    const anna = await tablet();
    await anna.page.evaluate(() => (globalThis.sameDocument = true));
    const place = await anna.besideTheRobot(smokemap.url);
    await anna.mark(place, 'Gas bottle', 'Acetylene');
    await anna.see('Acetylene');
    await anna.settled();
    await smokemap.kill();
    await anna.link('No link');
    await anna.mark([place[0] + 6, place[1]], 'Fire', 'Drawn without a link');
    await anna.page.waitForSelector('text=1 waiting');
    await smokemap.start();
    await anna.link('Live');
    await anna.settled();
    await anna.see('Acetylene');
    assert.equal(await anna.page.evaluate(() => globalThis.sameDocument), true);
    const carl = await tablet();
    await carl.see('Acetylene');
    await carl.see('Drawn without a link');
  });

  test('two tablets see each other and what the other marks', async () => {
    const [anna, bo] = [await tablet(), await tablet()];
    await anna.page.waitForSelector('.chip.people >> text=2');
    const [x, y] = await anna.besideTheRobot(smokemap.url);
    await anna.mark([x + 3, y + 3], 'Person', 'At the window');
    await bo.see('At the window');
    await bo.page.click('button:has-text("At the window")');
    await bo.page.click('[role=dialog] >> text=Remove');
    await anna.page.waitForSelector('text=At the window', { state: 'detached' });
  });

  test('a place of the plan is fixed on the map, shown with what is left, and let go again', async () => {
    const anna = await tablet();
    const probe = await Probe.open(smokemap.url);
    await anna.showEverything();
    const inside = await probe.until(({ info }) => info?.plan_nodes && mean(info.plan_nodes.map));
    await anna.tap(inside);
    await anna.page.click('[role=dialog] >> text=Fix the plan here');
    await anna.tap([inside[0] + 0.5, inside[1]]);
    await probe.until(({ anchors }) => Object.keys(anchors ?? {}).length === 1);
    await anna.page.click('button:has-text("Fixed point, off by")');
    await anna.page.click('[role=dialog] >> text=Let go');
    await probe.until(({ anchors }) => Object.keys(anchors ?? {}).length === 0);
    probe.close();
  });

  test('the stop is confirmed at once; a server that does not answer is shown as not confirmed', async () => {
    const anna = await tablet();
    await anna.page.click('button.stop');
    await anna.see('Stop confirmed');
    await anna.see('All robots are stopped.');
    await anna.hold('.banner .hold');
    await anna.page.waitForSelector('text=All robots are stopped.', { state: 'detached' });
    smokemap.signal('SIGSTOP');
    await anna.page.click('button.stop');
    await anna.see('STOP NOT CONFIRMED', 3_000);
    smokemap.signal('SIGCONT');
    await anna.page.waitForSelector('text=STOP NOT CONFIRMED', { state: 'detached' });
    await anna.see('All robots are stopped.');
    await anna.hold('.banner .hold');
    await anna.page.waitForSelector('text=All robots are stopped.', { state: 'detached' });
  });

  test('a robot reaches a room that it has not seen', async () => {
    const anna = await tablet();
    const probe = await Probe.open(smokemap.url);
    const room = await probe.until(unseenRoom, kLookAround);
    await anna.showEverything();
    await anna.tap(room);
    await anna.page.click('[role=dialog] >> text=Send robot');
    await anna.page.waitForSelector('[role=dialog] >> text=/\\d m to drive/'); // the way is shown before anybody is sent
    await anna.hold('[role=dialog] .hold');
    await anna.see('On its way');
    await anna.see('Arrived', kDrive);
    probe.close();
  });
});

/** The middle of the room farthest from the robot of which no wall was seen. */
function unseenRoom({ plan_regions, info, walls, robots }) {
  const mesh = info?.plan_mesh && { ...info.plan_mesh, ...info.plan_nodes };
  const robot = Object.values(robots ?? {})[0];
  if (!mesh || !robot || !plan_regions || !walls) return undefined;
  const seen = Object.values(walls).filter(({ state }) => state !== 'unseen');
  const rooms = Object.values(plan_regions)
    .filter(({ kind }) => kind === 'room')
    .map(({ outline }) => toMap(mesh, mean(outline)))
    .filter((p) => p && seen.every(({ a, b }) => Math.hypot(mean([a, b])[0] - p[0], mean([a, b])[1] - p[1]) > 4));
  return rooms.sort((p, q) => Math.hypot(q[0] - robot.x, q[1] - robot.y) - Math.hypot(p[0] - robot.x, p[1] - robot.y))[0];
}

const mean = (points) => [0, 1].map((axis) => points.reduce((sum, p) => sum + p[axis], 0) / points.length);

function toMap({ px, map, triangles }, p) {
  for (const [i, j, k] of triangles) {
    const [a, b, c] = [px[i], px[j], px[k]];
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    const v = ((p[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (p[1] - a[1])) / area;
    const w = ((b[0] - a[0]) * (p[1] - a[1]) - (p[0] - a[0]) * (b[1] - a[1])) / area;
    if (!(v >= 0 && w >= 0 && v + w <= 1)) continue;
    return [0, 1].map((axis) => (1 - v - w) * map[i][axis] + v * map[j][axis] + w * map[k][axis]);
  }
  return undefined;
}
