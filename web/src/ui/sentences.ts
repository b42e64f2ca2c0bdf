/** Says in another language what the server says in English. */
export type Say = (text: string) => string;

const kBlank = /\{\w+\}/;
const escaped = (text: string): string => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');

/** Text with blanks: how to recognise it, and what to say for it. The most fixed text first, so that "the picture {why}" comes after all that say more. */
function withBlanks(table: Readonly<Record<string, string>>): { readonly pattern: RegExp; readonly names: readonly string[]; readonly words: string }[] {
  return Object.entries(table)
    .filter(([english]) => kBlank.test(english))
    .sort(([a], [b]) => fixedLength(b) - fixedLength(a))
    .map(([english, words]) => ({
      pattern: new RegExp(`^${english.split(kBlank).map(escaped).join('(.+)')}$`),
      names: [...english.matchAll(/\{(\w+)\}/g)].map((match) => match[1]!),
      words,
    }));
}
const fixedLength = (english: string): number => english.replace(/\{\w+\}/g, '').length;

/**
 * From a table of the server's sentences (proto/sentences.json). What fills a blank is looked up too ("the robot cannot get on in the smoke:
 * {why}"). A text of several sentences is said sentence by sentence; what is not in the table stays as it is: nothing said is ever lost.
 */
export function sayer(table: Readonly<Record<string, string>>): Say {
  const patterns = withBlanks(table);
  const one = (text: string): string | undefined => {
    const whole = Object.hasOwn(table, text) ? table[text] : undefined;
    if (whole !== undefined) return whole;
    for (const { pattern, names, words } of patterns) {
      const fills = pattern.exec(text);
      if (fills) return words.replace(/\{(\w+)\}/g, (_, name: string) => say(fills[names.indexOf(name) + 1]!));
    }
    return undefined;
  };
  const say = (text: string): string => one(text) ?? text.split(/(?<=\.) (?=[A-Z0-9])/).map((sentence) => one(sentence) ?? sentence).join(' ');
  return say;
}

/** With a capital, unless it begins with a name such as "robot1". */
export const asSentence = (text: string): string =>
  /^\p{Ll}\p{L}*(?![\p{L}\p{N}_])/u.test(text) ? text.charAt(0).toUpperCase() + text.slice(1) : text;
