/**
 * OpenLayers' map imports its default controls and gestures, its vector layers with their style language, the icon cache
 * and the UTM projections whether or not a page has any of them: more than half of its size. This page brings its own
 * painters and gestures and never reaches that code, so these modules are replaced by the little that is called.
 */
import type { Plugin } from 'vite';

export const kReplaced: Readonly<Record<string, string>> = {
  // Only called when a map is made without saying which: Stage says none.
  'ol/control/defaults.js': 'export const defaults = () => [];',
  'ol/interaction/defaults.js': 'export const defaults = () => [];',
  // Asked for with instanceof only.
  'ol/layer/BaseVector.js': 'export default class {}',
  // View.fit draws a polygon around what it fits; Stage fits by itself.
  'ol/geom/Polygon.js': 'export const fromExtent = () => null;',
  // Turns pointer events into events of the map; ours go to `tools`.
  'ol/MapBrowserEventHandler.js': 'export default class { addEventListener() {} dispose() {} }',
  'ol/style/IconImageCache.js': 'export const shared = { canExpireCache: () => false, expire() {} };',
  'ol/proj/utm.js': 'export const makeProjection = () => null; export const makeTransforms = () => null;',
};

const keyOf = (id: string): string | undefined =>
  Object.keys(kReplaced).find((key) => id.replaceAll('\\', '/').endsWith(`/node_modules/${key}`));

export const leanOpenLayers = (): Plugin => ({
  name: 'smokemap-lean-openlayers',
  enforce: 'pre',
  load(id) {
    const key = keyOf(id.split('?')[0]!);
    return key && kReplaced[key];
  },
});
