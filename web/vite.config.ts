import { fileURLToPath } from 'node:url';
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vitest/config';
import { leanOpenLayers } from './build/lean_openlayers.ts';
import { serviceWorker } from './build/service_worker.ts';

export default defineConfig({
  plugins: [svelte(), leanOpenLayers(), serviceWorker(fileURLToPath(new URL('public', import.meta.url)))],
  build: {
    target: 'es2022',
    // The server's content security policy allows files of its own origin only: nothing is inlined as a data address.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
  },
  test: { include: ['test/**/*.test.ts'], environment: 'node' },
});
