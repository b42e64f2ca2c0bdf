/** Builds src/offline/service_worker.ts to /sw.js and tells it which files make up the page, and their version. */
import { createHash } from 'node:crypto';
import { readdirSync } from 'node:fs';
import type { Plugin } from 'vite';

const kName = 'sw';

export const serviceWorker = (publicFolder: string): Plugin => ({
  name: 'smokemap-service-worker',
  apply: 'build',
  enforce: 'post',
  config: () => ({
    build: {
      rolldownOptions: {
        input: { index: 'index.html', [kName]: 'src/offline/service_worker.ts' },
        output: { entryFileNames: ({ name }) => (name === kName ? `${kName}.js` : 'assets/[name]-[hash].js') },
      },
    },
  }),
  generateBundle(_, bundle) {
    const worker = bundle[`${kName}.js`];
    if (worker?.type !== 'chunk') return this.error('the service worker was not built');
    if (worker.imports.length > 0) return this.error('the service worker must be one file');
    const built = Object.keys(bundle).filter((file) => file !== worker.fileName && file !== 'index.html');
    const files = ['/', ...[...built, ...readdirSync(publicFolder)].sort().map((file) => `/${file}`)];
    const page = bundle['index.html'];
    const version = createHash('sha256')
      .update(JSON.stringify(files))
      .update(page?.type === 'asset' ? page.source : '')
      .digest('hex')
      .slice(0, 16);
    worker.code = worker.code.replace('__SMOKEMAP_FILES__', JSON.stringify(files)).replace('__SMOKEMAP_VERSION__', JSON.stringify(version));
  },
});
