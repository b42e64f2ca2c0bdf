// Pictures of every mode while the demo runs, and how soon a newcomer sees what: ./run bench web-screens [--out DIR] [--seconds 60]
// Starts the real server with the demo; across in light and upright in dark. Times are wall times from the start of the server.
import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { Probe } from '../../tests/e2e/support/probe.mjs';
import { Smokemap } from '../../tests/e2e/support/smokemap.mjs';
import { openBrowser, Tablet } from '../../tests/e2e/support/tablet.mjs';

const kDefaultOut = fileURLToPath(new URL('../../build/screens', import.meta.url));
const { values: options } = parseArgs({ options: { out: { type: 'string', default: kDefaultOut }, seconds: { type: 'string', default: '60' } } });
const kLooks = {
  'across-light': { viewport: { width: 1180, height: 820 }, colorScheme: 'light' },
  'upright-dark': { viewport: { width: 820, height: 1180 }, colorScheme: 'dark' },
};
const kModes = ['Prepare', 'Sketch', 'Match', 'Operate', 'Review'];

mkdirSync(options.out, { recursive: true });
const browser = await openBrowser();
const smokemap = new Smokemap();
const begun = Date.now();
const said = (what) => console.log(`${((Date.now() - begun) / 1000).toFixed(1).padStart(6)} s  ${what}`);
try {
  await smokemap.start();
  said('address printed');
  const probe = await Probe.open(smokemap.url);
  const tablet = await Tablet.open(browser, smokemap.url, kLooks['across-light']);
  await watchTheFirstMinute(probe, tablet);
  await doSomething(tablet);
  for (const [look, settings] of Object.entries(kLooks)) {
    const shown = await Tablet.open(browser, smokemap.url, settings);
    for (const mode of kModes) {
      await shown.mode(mode);
      await shown.settled();
      await shown.showEverything().catch(() => undefined); // Review has no such button
      await shown.page.screenshot({ path: `${options.out}/${mode.toLowerCase()}-${look}.png` });
    }
    await shown.close();
  }
  said(`pictures in ${options.out}`);
  probe.close();
} finally {
  await browser.close();
  await smokemap.dispose();
}

async function watchTheFirstMinute(probe, tablet) {
  await probe.until(({ robots }) => Object.values(robots ?? {}).some(({ localized }) => localized), 60_000);
  said('the robot knows where it is');
  await tablet.until(async () => (await tablet.paintedPixels()) > 1000);
  said('a map is painted');
  const walls = () => Object.values(probe.tables.walls ?? {});
  const inState = (...states) => walls().filter(({ state }) => states.includes(state)).length;
  await probe.until(() => inState('confirmed', 'moved') > 0, 60_000);
  said('the first wall is confirmed or moved');
  const [from, { map, rest }] = [Date.now(), { ...tablet.received }];
  await new Promise((resolve) => setTimeout(resolve, Number(options.seconds) * 1000 - (Date.now() - begun)));
  const perSecond = (bytes) => (bytes / (Date.now() - from)).toFixed(1);
  said(`live map ${perSecond(tablet.received.map - map)} kB/s, everything else ${perSecond(tablet.received.rest - rest)} kB/s`);
  said(['confirmed', 'moved', 'missing', 'new', 'unseen'].map((state) => `${inState(state)} ${state}`).join(', '));
}

/** A sketch, a mark and a goal, as a newcomer would make them. */
async function doSomething(tablet) {
  const place = await tablet.besideTheRobot(smokemap.url);
  await tablet.mark(place, 'Gas bottle', 'Workshop');
  await tablet.mode('Sketch');
  await tablet.draw([[0.3, 0.3], [0.75, 0.3], [0.75, 0.5], [0.3, 0.5], [0.3, 0.3]]);
  await tablet.draw([[0.45, 0.3], [0.45, 0.5]]);
  await tablet.draw([[0.6, 0.3], [0.6, 0.5]]);
  await tablet.draw([[0.3, 0.5], [0.3, 0.6], [0.75, 0.6], [0.75, 0.5]]);
  await tablet.settled();
}
