/** Every word on the screen, in one table per language; a missing key does not compile. */
import { en, type Key } from './words_en';
import { de } from './words_de';

export type Language = 'en' | 'de';
const kTables: Readonly<Record<Language, Readonly<Record<Key, string>>>> = { en, de };

const kStored = 'smokemap.language';

function preferred(): Language {
  const stored = globalThis.localStorage?.getItem(kStored);
  if (stored === 'en' || stored === 'de') return stored;
  return globalThis.navigator?.language.startsWith('de') ? 'de' : 'en';
}

let language = $state<Language>(preferred());

export const currentLanguage = (): Language => language;

export function setLanguage(next: Language): void {
  language = next;
  document.documentElement.lang = next;
  localStorage.setItem(kStored, next);
}

/** The words for `key`, with `{name}` replaced by `values.name`. */
export function t(key: Key, values: Readonly<Record<string, string | number>> = {}): string {
  return kTables[language][key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

export type { Key };
