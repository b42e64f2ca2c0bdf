// Every mode, in both themes, with and without gloves, upright and across: no serious finding of axe-core, and nothing to
// press that is smaller than a finger.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, describe, test } from 'node:test';
import { StandIn } from './support/stand_in.mjs';
import { openBrowser, Tablet } from './support/tablet.mjs';

const axe = readFileSync(createRequire(new URL('../../web/package.json', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8');
const kModes = ['Prepare', 'Sketch', 'Match', 'Operate', 'Review'];
const kSizes = { across: { width: 1180, height: 820 }, upright: { width: 820, height: 1180 } };

describe('for every hand and every eye', { timeout: 300_000 }, () => {
  let browser;
  const server = new StandIn();
  before(async () => {
    browser = await openBrowser();
    await server.start();
  });
  after(async () => {
    await browser?.close();
    server.stop();
  });

  for (const colorScheme of ['light', 'dark'])
    for (const [format, viewport] of Object.entries(kSizes))
      test(`no serious finding: ${colorScheme}, ${format}`, async () => {
        const anna = await Tablet.open(browser, server.url, { colorScheme, viewport });
        await anna.page.evaluate(axe);
        const findings = [];
        for await (const view of views(anna, format === 'across')) {
          const { violations } = await anna.page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
          for (const { id, impact, nodes } of violations)
            if (impact === 'serious' || impact === 'critical') findings.push(`${view}: ${id}: ${nodes.map(({ html, any }) => `${html.slice(0, 110)} ${any[0]?.message ?? ''}`).slice(0, 4).join(' | ')}`);
        }
        await anna.close();
        assert.deepEqual(findings, []);
      });

  for (const [hands, least] of Object.entries({ bare: 56, gloved: 96 }))
    test(`what is pressed is at least ${least} px wide and high for ${hands} hands`, async () => {
      const anna = await Tablet.open(browser, server.url);
      if (hands === 'gloved') await anna.page.click('[aria-label^="Gloves"]');
      const small = [];
      for await (const view of views(anna)) small.push(...(await anna.tooSmall(least)).map((what) => `${view}: ${what}`));
      await anna.close();
      assert.deepEqual(small, []);
    });
});

/** Every mode, and every card that a tap opens in it, one after the other. */
async function* views(anna, withCards = true) {
  const dialog = (words) => anna.page.click(`[role=dialog] >> text=${words}`);
  const opened = () => anna.page.waitForSelector('[role=dialog]');
  for (const mode of kModes) {
    await anna.mode(mode);
    yield mode;
  }
  await anna.page.click('.notices [aria-label=Close]'); // read and put away
  await anna.page.waitForSelector('.notices [role=status]', { state: 'detached' });
  if (!withCards) return;
  await anna.mode('Prepare');
  for (const step of await anna.page.locator('button.head').all()) {
    await step.click();
    yield `Prepare: ${await step.textContent()}`;
  }
  await anna.mode('Operate');
  await anna.page.click('button.where >> nth=0');
  yield 'a mark';
  await anna.showEverything(); // the mark's place may leave the rest of the map outside
  const onWall = [4, 8];
  const fixed = [20, 10];
  const free = [[27, 9.5], [30, 10.5], [33, 9.5], [36, 10.5]]; // apart: two quick taps at one place are a zoom
  for (const [name, words] of Object.entries({ 'what kind of mark': 'Mark', 'a goal': 'Send robot', 'where to fix the plan': 'Fix the plan here', 'a distance': 'Measure' })) {
    await anna.tap(free.pop());
    await opened();
    if (name === 'what kind of mark') yield 'a place';
    await dialog(words);
    yield name;
    await anna.page.keyboard.press('Escape');
  }
  await anna.tap(fixed);
  await opened();
  yield 'a fixed point';
  await anna.page.keyboard.press('Escape');
  await anna.tap(onWall);
  await opened();
  await dialog('Judge the wall');
  yield 'a wall';
  await anna.page.keyboard.press('Escape');
}
