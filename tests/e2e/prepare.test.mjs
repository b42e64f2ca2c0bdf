// A plan on its way from a picture to the map: corrected by tapping, put in use, and never lost on the way.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { drawnPlan } from './support/drawn_plan.mjs';
import { Probe } from './support/probe.mjs';
import { Smokemap } from './support/smokemap.mjs';
import { openBrowser, Tablet } from './support/tablet.mjs';

describe('a plan is prepared', { timeout: 150_000 }, () => {
  let browser;
  let smokemap;
  let anna;
  let layout;
  const counts = async () => (await anna.page.waitForSelector('text=/\\d+ walls, \\d+ doubtful/')).textContent();
  const walls = async () => Number(/(\d+) walls/.exec(await counts())[1]);
  const until = (words) => anna.page.waitForSelector(`text=${words}`);

  before(async () => {
    browser = await openBrowser();
    smokemap = new Smokemap();
    await smokemap.start();
    anna = await Tablet.open(browser, smokemap.url);
    await anna.mode('Prepare');
    const plan = await drawnPlan(anna.page);
    const read = anna.page.waitForResponse(/\/read$/);
    await anna.page.setInputFiles('[data-testid=plan-file]', { name: 'plan.png', mimeType: 'image/png', buffer: plan });
    layout = await (await read).json();
  });
  after(async () => {
    const errors = anna?.errors;
    await browser?.close();
    await smokemap?.dispose();
    assert.deepEqual(errors, []);
  });

  test('an uploaded picture becomes walls over it', async () => {
    const count = await walls();
    assert.ok(count >= 6 && count <= 40, `${count} walls were read`);
  });

  test('a tap switches a wall off, undo and redo go back and forth, and the taps are counted', async () => {
    const all = await walls();
    await anna.tap([300, -100]);
    await until(`${all - 1} walls`);
    await anna.page.click('.rail >> text=Undo');
    await until(`${all} walls`);
    await anna.page.click('.rail >> text=Redo');
    await until(`${all - 1} walls`);
    await until('Corrections by hand: 3');
  });

  test('a wall is drawn from corner to corner', async () => {
    const before_ = await walls();
    await anna.page.click('.rail >> text=Draw');
    await anna.drag([600, -452], [600, -548]);
    await until(`${before_ + 1} walls`);
    await anna.page.click('.rail >> text=Off / on');
  });

  test('a gap is told to be a window, or no gap at all', async () => {
    const [x1, y1, x2, y2] = layout.doors[0];
    const gap = [(x1 + x2) / 2, -(y1 + y2) / 2];
    await anna.tap(gap);
    assert.deepEqual(await anna.tooSmall(56), []);
    await anna.page.keyboard.press('Escape');
    await anna.page.click('[aria-label^="Gloves"]');
    await anna.tap(gap);
    assert.deepEqual(await anna.tooSmall(96), []);
    await anna.page.keyboard.press('Escape');
    await anna.page.click('[aria-label^="Gloves"]');
    await anna.tap(gap);
    await anna.page.click('[role=dialog] >> text=Window');
    await anna.tap(gap);
    await anna.page.waitForSelector('[role=dialog] [aria-pressed=true]:has-text("Window")');
    const before_ = await walls();
    await anna.page.click('[role=dialog] >> text=No gap');
    await until(`${before_ + 1} walls`);
    await anna.page.click('.rail >> text=Undo');
    await until(`${before_} walls`);
  });

  test('two points and a length give the scale', async () => {
    await anna.page.click('.head:has-text("Scale")');
    await anna.tap([100, -300]);
    await anna.tap([1100, -300]);
    await anna.page.fill('form input', '25');
    await anna.page.click('form button');
    await until('100 pixels are 2.50 m');
  });

  test('corners are dragged, and the sheet is read again within them', async () => {
    await anna.page.click('.head:has-text("Corners")');
    await anna.drag([36, -24], [60, -60]);
    await anna.page.click('text=Read with these corners');
    await anna.page.waitForSelector('li.open:has-text("Walls")');
    assert.ok((await walls()) >= 6);
    await anna.page.click('.rail >> text=Undo');
    await anna.page.click('.head:has-text("Scale")');
    await until('100 pixels are 2.50 m');
  });

  test('after a reload the work goes on where it was', async () => {
    const kept = await counts();
    await anna.page.reload();
    await anna.link('Live');
    await anna.mode('Prepare');
    assert.equal(await counts(), kept);
    await anna.page.waitForSelector('.rail >> text=Undo');
  });

  test('put in use without a link, it is in use when the link is back', async () => {
    const count = await walls();
    await smokemap.kill();
    await anna.link('No link');
    await anna.page.click('text=Use this plan');
    await until('1 waiting');
    await smokemap.start();
    await anna.see('The plan is in use.');
    const probe = await Probe.open(smokemap.url);
    const floor = await probe.until(({ info, layout_walls }) => Object.keys(layout_walls ?? {}).length === count && info?.floor);
    assert.ok(Math.abs(floor.metres_per_pixel - 0.025) < 1e-6);
    probe.close();
  });

  test('of two floors on a sheet the one that was not read can be tapped', async () => {
    const answer = async (act) => {
      const read = anna.page.waitForResponse(/\/read$/);
      await act();
      return (await read).json();
    };
    const buffer = await drawnPlan(anna.page, 2);
    await anna.page.click('.head:has-text("Picture")');
    const first = await answer(() => anna.page.setInputFiles('[data-testid=plan-file]', { name: 'floors.png', mimeType: 'image/png', buffer }));
    await until('The sheet shows 2 drawings');
    const isUpper = ({ walls }) => walls.every(([, y1, , y2]) => y1 < 800 && y2 < 800);
    await anna.showEverything();
    const second = await answer(() => anna.tap([600, isUpper(first) ? -1200 : -400]));
    assert.equal(isUpper(second), !isUpper(first));
    await until(`${second.walls.length} walls`);
  });
});
