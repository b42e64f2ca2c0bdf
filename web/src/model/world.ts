/**
 * Everything the server told, as immutable tables. `apply` is the only way in; it never mutates what it was given, so a
 * view may hold on to a world and compare by identity.
 */
import type { PlanMesh } from '../geometry/mesh';
import type { Message } from '../wire/messages';
import * as v from 'valibot';
import {
  type Floor,
  infoSchemas,
  isPartName,
  parseTable,
  type PartName,
  type PartObject,
  partNames,
  type SketchSheet,
} from '../wire/parts';

export type Table<T> = ReadonlyMap<string, T>;
export type Tables = { readonly [P in PartName]: Table<PartObject<P>> };

export interface World {
  readonly floor: Floor | null;
  readonly planMesh: PlanMesh | null;
  readonly sheet: SketchSheet;
  readonly tables: Tables;
  /** Latest revision seen per part: a delta that is older is a late duplicate. */
  readonly revisions: Readonly<Partial<Record<PartName | 'info', number>>>;
}

export const kEmptyWorld: World = {
  floor: null,
  planMesh: null,
  sheet: { size: [1024, 768], warning: '' },
  tables: Object.fromEntries(partNames.map((name) => [name, new Map()])) as unknown as Tables,
  revisions: {},
};

export type Applied =
  | { readonly ok: true; readonly world: World; readonly dropped: number }
  | { readonly ok: false; readonly reason: 'stale' | 'unknown part' };

export function apply(world: World, delta: Omit<Message<'delta'>, 'type'>): Applied {
  const { part, rev, reset } = delta;
  if (part !== 'info' && !isPartName(part)) return { ok: false, reason: 'unknown part' };
  const known = world.revisions[part];
  if (!reset && known !== undefined && rev < known) return { ok: false, reason: 'stale' };
  const revisions = { ...world.revisions, [part]: rev };
  if (part === 'info') return applyInfo({ ...world, revisions }, delta);
  const { objects, dropped } = parseTable(part, delta.set);
  const table: Map<string, unknown> = reset ? objects : new Map<string, unknown>(world.tables[part]);
  if (!reset) for (const [id, object] of objects) table.set(id, object);
  for (const id of delta.del) table.delete(id);
  return { ok: true, dropped, world: { ...world, revisions, tables: { ...world.tables, [part]: table } } };
}

function applyInfo(world: World, { reset, set, del }: Omit<Message<'delta'>, 'type'>): Applied {
  let { floor, planMesh, sheet } = reset ? kEmptyWorld : world;
  let dropped = 0;
  if ('floor' in set) {
    const parsed = v.safeParse(infoSchemas.floor, set['floor']);
    if (parsed.success) floor = parsed.output;
    else dropped++;
  }
  if ('plan_mesh' in set || 'plan_nodes' in set) {
    const mesh = v.safeParse(infoSchemas.plan_mesh, set['plan_mesh'] ?? planMesh);
    const nodes = v.safeParse(infoSchemas.plan_nodes, set['plan_nodes'] ?? planMesh);
    if (mesh.success && nodes.success) planMesh = { ...mesh.output, ...nodes.output };
    else dropped++;
  }
  if ('sketch' in set) {
    const parsed = v.safeParse(infoSchemas.sketch, set['sketch']);
    if (parsed.success) sheet = parsed.output;
    else dropped++;
  }
  if (del.includes('floor')) floor = null;
  if (del.includes('plan_mesh') || del.includes('plan_nodes')) planMesh = null;
  return { ok: true, dropped, world: { ...world, floor, planMesh, sheet } };
}

/** A world from a snapshot of the past (GET /api/snapshot). */
export function worldFromSnapshot(parts: Readonly<Record<string, Record<string, unknown>>>): World {
  let world = kEmptyWorld;
  for (const [part, set] of Object.entries(parts)) {
    const applied = apply(world, { part, rev: 0, reset: true, set, del: [] });
    if (applied.ok) world = applied.world;
  }
  return world;
}
