/** Which room of the sketch is which room of the plan, as people see it: one colour per pair, worst first. */
import type { Xy } from '../geometry/points';
import { contains, signedArea } from '../geometry/polygon';
import type { Pair } from '../wire/parts';
import type { World } from './world';

export type Level = 'sure' | 'likely' | 'doubtful';

/** Three levels, not percent: that is as much as the number can carry. */
export const levelOf = (confidence: number): Level =>
  confidence >= 0.8 ? 'sure' : confidence >= 0.5 ? 'likely' : 'doubtful';

/** A room of the sketch keeps its colour on every page; a matched room of the plan takes it over. */
export const colourOfSketchRegion = (label: number): number => label - 1;

export interface MatchRow extends Pair {
  readonly id: string;
  /** Index into the pair colours; the same on both sides. */
  readonly colour: number;
}

/** Standing pairs, worst first; what a person confirmed comes last. */
export function matchRows(world: World): MatchRow[] {
  const standing = [...world.tables.pairs].filter(([, pair]) => pair.verdict !== 'rejected');
  return standing
    .map(([id, pair]): MatchRow => ({ ...pair, id, colour: colourOfSketchRegion(pair.sketch) }))
    .sort(
      (a, b) =>
        Number(a.verdict === 'confirmed') - Number(b.verdict === 'confirmed') ||
        a.confidence - b.confidence ||
        a.sketch - b.sketch,
    );
}

/** The room at a place. Outlines of neighbours may overlap: the smaller one is meant, the larger can be tapped elsewhere. */
export function regionAt(regions: ReadonlyMap<string, { readonly outline: readonly Xy[] }>, p: Xy): number | undefined {
  let best: number | undefined;
  let least = Infinity;
  for (const [id, { outline }] of regions) {
    const area = Math.abs(signedArea(outline));
    if (area < least && contains(outline, p)) [best, least] = [Number(id), area];
  }
  return best;
}

export interface Judgement {
  readonly sketch: number;
  readonly plan: number;
  readonly verdict: 'proposed' | 'confirmed' | 'rejected';
}

/** "This room is that room": the new pair is confirmed, every standing pair of either room that says otherwise is rejected. */
export function relink(rows: readonly MatchRow[], sketch: number, plan: number): Judgement[] {
  const wrong = rows
    .filter((row) => (row.sketch === sketch) !== (row.plan === plan))
    .filter((row) => row.sketch === sketch || row.plan === plan)
    .map((row): Judgement => ({ sketch: row.sketch, plan: row.plan, verdict: 'rejected' }));
  return [...wrong, { sketch, plan, verdict: 'confirmed' }];
}

/** What `relink` changes, the other way round. */
export function unrelink(rows: readonly MatchRow[], sketch: number, plan: number): Judgement[] {
  const before = rows.filter((row) => row.sketch === sketch || row.plan === plan);
  const restored = before.map((row): Judgement => ({ sketch: row.sketch, plan: row.plan, verdict: row.verdict }));
  const existed = before.some((row) => row.sketch === sketch && row.plan === plan);
  return existed ? restored : [{ sketch, plan, verdict: 'proposed' }, ...restored];
}
