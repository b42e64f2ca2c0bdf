// A tablet in somebody's hands: opens the page, changes modes, taps places of the map, and reads what the page says.
import { createRequire } from 'node:module';
import { Probe } from './probe.mjs';

const { chromium } = createRequire(new URL('../../../web/package.json', import.meta.url))('playwright-core');

const kFlags = [
  '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
];
export const kPatientMs = 30_000;

export const openBrowser = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: kFlags });

export class Tablet {
  #context;
  page;
  errors = [];
  /** Bytes that came over the live link. */
  received = { map: 0, rest: 0 };

  /** @param options of the browser: size, colours. */
  static async open(browser, url, options = {}) {
    const tablet = new Tablet();
    tablet.#context = await browser.newContext({ viewport: { width: 1180, height: 820 }, locale: 'en-GB', ...options });
    tablet.page = await tablet.#context.newPage();
    tablet.page.setDefaultTimeout(kPatientMs);
    tablet.page.on('pageerror', (error) => tablet.errors.push(String(error)));
    tablet.page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => (tablet.received[typeof payload === 'string' ? 'rest' : 'map'] += payload.length)));
    await tablet.page.goto(url);
    await tablet.page.waitForSelector('[data-mode=operate]');
    await tablet.link('Live');
    return tablet;
  }

  close() {
    return this.#context.close();
  }

  /** Waits until the status bar says so about the link. */
  link(word) {
    return this.page.waitForSelector(`[data-testid=link]:has-text("${word}")`);
  }

  async mode(name) {
    await this.page.click(`nav >> text=${name}`);
    await this.page.waitForSelector(`[data-mode=${name.toLowerCase()}] [data-view]`);
  }

  see(text, timeout = kPatientMs) {
    return this.page.waitForSelector(`text=${text}`, { timeout });
  }

  /** Taps a place of a canvas' own world: metres of the map, or pixels of a picture with y up. */
  async tap(p, canvas = 0) {
    await this.page.mouse.click(...(await this.#onScreen(p, canvas)));
  }

  async drag(from, to, canvas = 0) {
    await this.page.mouse.move(...(await this.#onScreen(from, canvas)));
    await this.page.mouse.down();
    await this.page.mouse.move(...(await this.#onScreen(to, canvas)), { steps: 8 });
    await this.page.mouse.up();
  }

  async #onScreen([x, y], canvas) {
    const target = this.page.locator('[data-view]').nth(canvas);
    const box = await target.boundingBox();
    const [cx, cy, resolution, rotation] = (await this.#viewAtRest(target)).split(' ').map(Number);
    if (Math.abs(rotation) > 1e-9) throw new Error('the view is turned');
    const [right, down] = [box.width / 2 + (x - cx) / resolution, box.height / 2 - (y - cy) / resolution];
    if (right < 0 || down < 0 || right > box.width || down > box.height) throw new Error(`(${x}, ${y}) is outside of what is shown`);
    return [box.x + right, box.y + down];
  }

  /** A canvas that was just opened is still being fitted to what it shows. */
  async #viewAtRest(target) {
    for (let before = ''; ; ) {
      const now = await target.getAttribute('data-view');
      if (now === before) return now;
      before = now;
      await this.#painted();
    }
  }

  #painted() {
    return this.page.evaluate(() => new Promise((painted) => requestAnimationFrame(() => requestAnimationFrame(painted))));
  }

  /** Draws a stroke through canvas points, as fractions of its width and height. */
  async draw(points) {
    const box = await this.page.locator('[data-view]').first().boundingBox();
    const at = ([u, v]) => [box.x + u * box.width, box.y + v * box.height];
    await this.page.mouse.move(...at(points[0]));
    await this.page.mouse.down();
    for (const point of points.slice(1)) await this.page.mouse.move(...at(point), { steps: 12 });
    await this.page.mouse.up();
  }

  /** Marks something where the map is tapped. */
  async mark(p, kind, label) {
    await this.tap(p);
    await this.page.click('[role=dialog] >> text=Mark');
    if (label) await this.page.fill('[role=dialog] input', label);
    await this.page.click(`[role=dialog] >> text=${kind}`);
  }

  async hold(selector) {
    const box = await this.page.locator(selector).boundingBox();
    await this.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await this.page.mouse.down();
    await this.page.waitForFunction(() => !document.querySelector('.hold.holding'));
    await this.page.mouse.up();
  }

  /** Where a mark can be put: beside the robot. */
  async besideTheRobot(url, ms = 120_000) {
    const probe = await Probe.open(url);
    const { x, y } = await probe.until(({ robots }) => Object.values(robots ?? {}).find(({ localized }) => localized), ms);
    probe.close();
    return [x + 0.5, y + 0.5];
  }

  /** How many pixels of the canvases are painted. */
  paintedPixels() {
    return this.page.evaluate(() => {
      let painted = 0;
      for (const canvas of document.querySelectorAll('canvas.map-canvas')) {
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        for (let i = 3; i < data.length; i += 4) if (data[i] > 0) painted++;
      }
      return painted;
    });
  }

  /** Shows the whole map, and waits until it is painted. */
  async showEverything() {
    await this.page.click('[aria-label="Show everything"]');
    await this.#painted();
  }

  /** Waits until `look` gives something. */
  async until(look, ms = kPatientMs) {
    for (const end = Date.now() + ms; Date.now() < end; ) {
      const found = await look();
      if (found) return found;
      await this.#painted();
    }
    throw new Error('what was waited for never came');
  }

  /** Every act is with the server: nothing waits. */
  async settled() {
    await this.page.waitForFunction(() => !document.querySelector('[data-testid=link]').textContent.includes('waiting'));
  }

  /** Controls that are shown and smaller than `least` pixels. */
  tooSmall(least) {
    return this.page.evaluate(smallControls, least);
  }
}

/** Runs in the page. A label around an input counts as the input. */
function smallControls(least) {
  const found = [];
  for (const control of document.querySelectorAll('button, input:not([hidden]), select, textarea, a[href]')) {
    const { width, height } = (control.closest('label') ?? control).getBoundingClientRect();
    if (width === 0 && height === 0) continue;
    if (Math.min(width, height) < least - 0.5) found.push(`${control.outerHTML.slice(0, 120)} ${Math.round(width)} x ${Math.round(height)}`);
  }
  return found;
}
