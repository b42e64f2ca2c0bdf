// Script time per frame while two fingers move, scale and turn the live map:
//   FAKE_WALLS=5000 node dev/fake_server.mjs 8091 & node dev/measure_frames.mjs http://127.0.0.1:8091/
import { chromium } from 'playwright-core';

const url = process.argv[2] ?? 'http://127.0.0.1:8091/';
const kFrames = 200;
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu'] });
const context = await browser.newContext({ viewport: { width: 1180, height: 820 }, hasTouch: true });
const page = await context.newPage();
await page.goto(url);
await page.waitForSelector('[data-mode=operate]');
await page.waitForTimeout(2000);
const cdp = await context.newCDPSession(page);
await cdp.send('Performance.enable');
const metrics = async () => Object.fromEntries((await cdp.send('Performance.getMetrics')).metrics.map(({ name, value }) => [name, value]));
await page.evaluate(() => {
  globalThis.frames_ = 0;
  globalThis.spans_ = [];
  const count = () => {
    globalThis.frames_++;
    requestAnimationFrame(count);
  };
  requestAnimationFrame(count);
});
const fingers = (type, i) => {
  const turn = i / 60;
  const spread = 120 + 60 * Math.sin(i / 25);
  const [x, y] = [420 + 80 * Math.sin(i / 40), 400 + 40 * Math.cos(i / 30)];
  const touchPoints = type === 'touchEnd' ? [] : [-1, 1].map((side, id) => ({ x: x + side * spread * Math.cos(turn), y: y + side * spread * Math.sin(turn), id }));
  return cdp.send('Input.dispatchTouchEvent', { type, touchPoints });
};
const idleFrom = await metrics();
await page.waitForTimeout(3000);
const idleTo = await metrics();
await fingers('touchStart', 0);
const from = await metrics();
const framesFrom = await page.evaluate(() => globalThis.frames_);
for (let i = 1; i <= kFrames; i++) await fingers('touchMove', i);
const to = await metrics();
const frames = (await page.evaluate(() => globalThis.frames_)) - framesFrom;
await fingers('touchEnd', 0);
const ms = (name, a, b) => (b[name] - a[name]) * 1000;
console.log(`live, nobody touching: ${(ms('ScriptDuration', idleFrom, idleTo) / 3).toFixed(1)} ms of script a second`);
console.log(`gesture: ${frames} frames, ${(ms('ScriptDuration', from, to) / frames).toFixed(2)} ms of script a frame (${kFrames} moves of two fingers, live tiles and deltas included)`);
console.log(`heap ${(to.JSHeapUsedSize / 1e6).toFixed(1)} MB`);
await browser.close();
