/** Every word on the screen, in one table per language; a missing key does not compile. English is there at once, others when wanted. */
import { asSentence, sayer, type Say } from './sentences';
import { en, type Key } from './words_en';

export type Language = 'en' | 'de';
export type Words = Readonly<Record<Key, string>>;

interface Dictionary {
  readonly words: Words;
  /** What the server said, which speaks English. */
  readonly say: Say;
}
const kEnglish: Dictionary = { words: en, say: (text) => text };

const kLoaders: Readonly<Record<Language, () => Promise<Dictionary>>> = {
  en: () => Promise.resolve(kEnglish),
  de: async () => {
    const [{ de }, { sentencesDe }] = await Promise.all([import('./words_de'), import('./sentences_de')]);
    return { words: de, say: sayer(sentencesDe) };
  },
};
const kStored = 'smokemap.language';

function preferred(): Language {
  const stored = globalThis.localStorage?.getItem(kStored);
  if (stored === 'en' || stored === 'de') return stored;
  return globalThis.navigator?.language.startsWith('de') ? 'de' : 'en';
}

let language = $state<Language>('en');
let dictionary = $state.raw(kEnglish);

export const currentLanguage = (): Language => language;

/** Without a link the words may not come: then the page stays as it is. */
export async function setLanguage(next: Language): Promise<void> {
  const loaded = await kLoaders[next]().catch(() => undefined);
  if (!loaded) return;
  dictionary = loaded;
  language = next;
  document.documentElement.lang = next;
  localStorage.setItem(kStored, next);
}

export const startLanguage = (): Promise<void> => setLanguage(preferred());

/** The words for `key`, with `{name}` replaced by `values.name`. */
export function t(key: Key, values: Readonly<Record<string, string | number>> = {}): string {
  return dictionary.words[key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

/** What the server said, in the page's language, to stand in the middle of a sentence ... */
export const saidWithin = (text: string): string => dictionary.say(text);
/** ... or alone. */
export const said = (text: string): string => asSentence(dictionary.say(text));

export type { Key };
