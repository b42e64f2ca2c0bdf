// Pictures of every mode in both themes and three formats, to be looked at: node dev/shots.mjs URL FOLDER [only]
import { chromium } from 'playwright-core';

const [url = 'http://127.0.0.1:8090/', folder = '/tmp', only = ''] = process.argv.slice(2);
const sizes = { landscape: [1180, 820], portrait: [820, 1180], phone: [390, 844] };
const modes = ['prepare', 'sketch', 'match', 'operate', 'review'];
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
for (const [format, [width, height]] of Object.entries(sizes)) {
  for (const theme of ['light', 'dark']) {
    const context = await browser.newContext({ viewport: { width, height }, colorScheme: theme, locale: 'en-GB' });
    const page = await context.newPage();
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && console.log(format, theme, message.text()));
    page.on('pageerror', (error) => console.log(format, theme, String(error)));
    await page.goto(url);
    await page.waitForSelector('[data-mode]');
    for (const mode of modes) {
      const name = `${mode}-${format}-${theme}`;
      if (!name.includes(only)) continue;
      await page.click(`nav button:nth-child(${modes.indexOf(mode) + 1})`);
      await page.waitForTimeout(1200);
      await page.screenshot({ path: `${folder}/${name}.png` });
    }
    await context.close();
  }
}
await browser.close();
