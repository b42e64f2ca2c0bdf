/** Every word on the screen, in one table per language; a missing key does not compile. English is there at once, others when wanted. */
import { en, type Key } from './words_en';

export type Language = 'en' | 'de';
export type Words = Readonly<Record<Key, string>>;

const kLoaders: Readonly<Record<Language, () => Promise<Words>>> = {
  en: () => Promise.resolve(en),
  de: () => import('./words_de').then(({ de }) => de),
};
const kStored = 'smokemap.language';

function preferred(): Language {
  const stored = globalThis.localStorage?.getItem(kStored);
  if (stored === 'en' || stored === 'de') return stored;
  return globalThis.navigator?.language.startsWith('de') ? 'de' : 'en';
}

let language = $state<Language>('en');
let words = $state.raw<Words>(en);

export const currentLanguage = (): Language => language;

/** Without a link the words may not come: then the page stays as it is. */
export async function setLanguage(next: Language): Promise<void> {
  const loaded = await kLoaders[next]().catch(() => undefined);
  if (!loaded) return;
  words = loaded;
  language = next;
  document.documentElement.lang = next;
  localStorage.setItem(kStored, next);
}

export const startLanguage = (): Promise<void> => setLanguage(preferred());

/** The words for `key`, with `{name}` replaced by `values.name`. */
export function t(key: Key, values: Readonly<Record<string, string | number>> = {}): string {
  return words[key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

export type { Key };
