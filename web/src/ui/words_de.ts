import { en, type Key } from './words_en';

export const de: Readonly<Record<Key, string>> = { ...en };
