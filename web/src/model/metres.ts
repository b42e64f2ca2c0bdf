/** Lengths that a wall or a distance on a plan can have, m. */
const kLeast = 0.1;
const kMost = 500;

/** A length as people type it: "4.2", "4,2", " 4.2 m". Null for anything else, and for what no wall can be. */
export function parseMetres(text: string): number | null {
  const match = /^\s*(\d+(?:[.,]\d*)?|[.,]\d+)\s*m?\s*$/i.exec(text);
  if (!match) return null;
  const metres = Number(match[1]!.replace(',', '.'));
  return metres >= kLeast && metres <= kMost ? metres : null;
}
