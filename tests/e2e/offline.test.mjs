// The first load is small, and a page that is loaded again without a server shows what it last knew, and how old that is.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Probe } from './support/probe.mjs';
import { Smokemap } from './support/smokemap.mjs';
import { openBrowser, Tablet } from './support/tablet.mjs';

const kFirstLoadBytes = 90_000;

describe('with and without a link', { timeout: 120_000 }, () => {
  let browser;
  let smokemap;
  let anna;
  before(async () => {
    browser = await openBrowser();
    smokemap = new Smokemap();
    await smokemap.start();
    anna = await Tablet.open(browser, smokemap.url);
  });
  after(async () => {
    await browser.close();
    await smokemap.dispose();
  });

  test('the page with the live map is loaded with 90 kB', async () => {
    const { page } = anna;
    const parts = await page.evaluate(() => {
      const entries = [...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')];
      const words = /(\/|\.js|\.css|\.html|\.svg)$/;
      return entries.filter(({ name, initiatorType }) => words.test(name) && initiatorType !== 'fetch').map(({ name, encodedBodySize }) => [name, encodedBodySize]);
    });
    const bytes = parts.reduce((sum, [, size]) => sum + size, 0);
    assert.ok(bytes > 20_000 && bytes <= kFirstLoadBytes, `${bytes} bytes: ${JSON.stringify(parts)}`);
  });

  test('loaded again without a server it shows the last state with its age, and goes on when the server is back', async () => {
    const { page } = anna;
    const place = await anna.besideTheRobot(smokemap.url);
    await anna.mark(place, 'Gas bottle', 'Before the reload');
    await anna.settled();
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForFunction(() => navigator.serviceWorker.controller !== null);
    const painted = await anna.paintedPixels();
    assert.ok(painted > 1000);
    await anna.until(() => page.evaluate(keptOnDisk, 'Before the reload'));
    await smokemap.kill();
    await page.reload();
    await anna.see('Before the reload');
    await anna.link('No link');
    await page.waitForSelector('text=/What you see is .* old/');
    assert.ok((await anna.paintedPixels()) > painted / 2, 'what the robots saw is drawn');
    await anna.mode('Review');
    await anna.mode('Prepare');
    await anna.mode('Sketch');
    await smokemap.start();
    await anna.link('Live');
  });
});

/** Does the state on the disk hold a mark of this name? */
async function keptOnDisk(label) {
  const open = (name) => new Promise((resolve) => (indexedDB.open(name).onsuccess = ({ target }) => resolve(target.result)));
  for (const { name } of await indexedDB.databases()) {
    const db = await open(name);
    const state = await new Promise((resolve) => (db.transaction('state').objectStore('state').get('last').onsuccess = ({ target }) => resolve(target.result)));
    db.close();
    if (Object.values(state?.parts.pois ?? {}).some((poi) => poi.label === label)) return true;
  }
  return false;
}
