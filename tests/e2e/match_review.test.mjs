// Which room of the sketch is which room of the plan, corrected by tapping; and a look back at how it was before.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Probe } from './support/probe.mjs';
import { Smokemap } from './support/smokemap.mjs';
import { openBrowser, Tablet } from './support/tablet.mjs';

describe('sketch and plan', { timeout: 150_000 }, () => {
  let browser;
  let smokemap;
  let anna;
  let probe;
  before(async () => {
    browser = await openBrowser();
    smokemap = new Smokemap();
    await smokemap.start();
    anna = await Tablet.open(browser, smokemap.url);
    probe = await Probe.open(smokemap.url);
    await anna.mode('Sketch');
    // Three rooms along a corridor.
    await anna.draw([[0.3, 0.3], [0.75, 0.3], [0.75, 0.5], [0.3, 0.5], [0.3, 0.3]]);
    await anna.draw([[0.45, 0.3], [0.45, 0.5]]);
    await anna.draw([[0.6, 0.3], [0.6, 0.5]]);
    await anna.draw([[0.3, 0.5], [0.3, 0.6], [0.75, 0.6], [0.75, 0.5]]);
    await probe.until(({ sketch_regions, pairs }) => Object.keys(sketch_regions ?? {}).length >= 4 && Object.keys(pairs ?? {}).length > 0);
  });
  after(async () => {
    const errors = anna?.errors;
    probe?.close();
    await browser?.close();
    await smokemap?.dispose();
    assert.deepEqual(errors, []);
  });

  test('a room is linked to another one with two taps, and undo takes it back', async () => {
    await anna.mode('Match');
    await anna.page.waitForSelector('.row .swatch');
    const { sketch_regions, plan_regions, pairs } = probe.tables;
    // Outlines of neighbours may overlap a little: only places that belong to one room are tapped.
    const isAlone = (regions, p) => Object.values(regions).filter((region) => contains(region.outline, p)).length === 1;
    const [sketch, { outline }] = Object.entries(sketch_regions).find(([, region]) => isAlone(sketch_regions, inside(region.outline)));
    const taken = new Set(Object.values(pairs).filter((pair) => String(pair.sketch) === sketch).map(({ plan }) => String(plan)));
    const [, other] = Object.entries(plan_regions).find(
      ([plan, region]) => region.kind === 'room' && !taken.has(plan) && isAlone(plan_regions, inside(region.outline)),
    );
    const from = inside(outline);
    const to = inside(other.outline);
    await anna.tap([from[0], -from[1]], 0);
    await anna.page.waitForSelector('text=now tap its room on the plan');
    await anna.tap([to[0], -to[1]], 1);
    const isLinked = ({ pairs: now, sketch_regions: left, plan_regions: right }) =>
      Object.values(now ?? {}).some(
        (pair) => pair.verdict === 'confirmed' && contains(left[pair.sketch]?.outline, from) && contains(right[pair.plan]?.outline, to),
      );
    await probe.until((tables) => isLinked(tables));
    await anna.page.waitForSelector('.row >> text=kept by a person');
    await anna.mode('Sketch');
    await anna.page.click('.rail >> text=Undo');
    await probe.until((tables) => !isLinked(tables));
  });

  test('a tap on a pair keeps it, another takes that back', async () => {
    await anna.mode('Match');
    const keep = anna.page.locator('.row [aria-label=Keep]').first();
    await keep.click();
    await anna.page.waitForSelector('.row >> text=kept by a person');
    await anna.page.locator('.row .kept').first().click();
    await anna.page.waitForSelector('.row >> text=kept by a person', { state: 'detached' });
  });

  test('Review goes back to the time before an act, and to now', async () => {
    await anna.mode('Operate');
    const place = await anna.besideTheRobot(smokemap.url);
    await anna.mark(place, 'Gas bottle', 'First bottle');
    await anna.settled();
    await anna.mark([place[0] + 6, place[1]], 'Fire', 'Later fire');
    await anna.settled();
    await anna.mode('Review');
    await anna.page.click('.event:has-text("Mark placed") >> nth=1');
    await anna.page.waitForSelector('text=/As it was at/');
    const seen = await anna.page.locator('.event[aria-pressed=true] small').last().textContent();
    const answer = await anna.page.evaluate(async (at) => {
      const { token } = JSON.parse(localStorage.getItem('smokemap.identity'));
      const response = await fetch(`/api/snapshot?at=${at}`, { headers: { Authorization: `Bearer ${token}` } });
      return Object.values((await response.json()).parts.pois).map(({ label }) => label);
    }, Number(seen.slice(1)));
    assert.deepEqual(answer, ['First bottle']);
    await anna.page.click('text=Back to now');
    await anna.page.waitForSelector('text=/As it was at/', { state: 'detached' });
  });
});

/** A point of the polygon: the middle of its widest row of ten. */
function inside(outline) {
  const ys = outline.map(([, y]) => y);
  let best = [0, 0, 0];
  for (let i = 1; i < 10; i++) {
    const y = Math.min(...ys) + ((Math.max(...ys) - Math.min(...ys)) * i) / 10;
    const xs = outline
      .map((p, k) => [p, outline[(k + 1) % outline.length]])
      .filter(([a, b]) => a[1] > y !== b[1] > y)
      .map(([a, b]) => a[0] + ((y - a[1]) / (b[1] - a[1])) * (b[0] - a[0]))
      .sort((a, b) => a - b);
    for (let k = 0; k + 1 < xs.length; k += 2) if (xs[k + 1] - xs[k] > best[0]) best = [xs[k + 1] - xs[k], (xs[k] + xs[k + 1]) / 2, y];
  }
  return [best[1], best[2]];
}

function contains(outline = [], [x, y]) {
  let odd = false;
  outline.forEach((a, i) => {
    const b = outline[(i + 1) % outline.length];
    if (a[1] > y !== b[1] > y && x < a[0] + ((y - a[1]) / (b[1] - a[1])) * (b[0] - a[0])) odd = !odd;
  });
  return odd;
}
