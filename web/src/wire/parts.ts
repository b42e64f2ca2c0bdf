/**
 * The tables of which everything that can be shown consists (docs/wire.md, section 2). One schema per kind of object; an
 * object that does not fit is left out and counted, it never reaches a screen. Unknown fields are ignored.
 */
import * as v from 'valibot';

const number = v.pipe(v.number(), v.finite());
const point = v.pipe(v.tuple([number, number]), v.readonly());
const points = v.array(point);
const segment = v.pipe(v.tuple([number, number, number, number]), v.readonly());
const flag = (otherwise: boolean) => v.optional(v.boolean(), otherwise);
const text = v.optional(v.string(), '');

export const placeFrame = v.picklist(['layout_px', 'sketch_px', 'map']);
export type PlaceFrame = v.InferOutput<typeof placeFrame>;

export const poiKinds = [
  'gas_bottle', 'victim', 'fire', 'hazard', 'exit', 'water', 'access', 'shut_off', 'note',
] as const;
export const poiKind = v.picklist(poiKinds);
export type PoiKind = v.InferOutput<typeof poiKind>;

export const wallStates = ['confirmed', 'moved', 'unseen', 'missing', 'new'] as const;
export type WallState = (typeof wallStates)[number];

export const strokeKind = v.picklist(['wall', 'door', 'note']);
export type StrokeKind = v.InferOutput<typeof strokeKind>;

export const verdict = v.picklist(['proposed', 'confirmed', 'rejected']);
export type Verdict = v.InferOutput<typeof verdict>;

export const goalStates = ['queued', 'sent', 'driving', 'arrived', 'refused', 'cancelled', 'failed'] as const;
export type GoalState = (typeof goalStates)[number];

export const role = v.picklist(['observer', 'firefighter', 'commander']);
export type Role = v.InferOutput<typeof role>;

const floor = v.object({
  plan_id: v.nullish(v.string(), null),
  picture: v.nullish(v.string(), null),
  size: v.nullish(point, null),
  metres_per_pixel: v.nullish(number, null),
  fit: v.nullish(v.object({ score: number, verdict: v.string() }), null),
  revision: v.optional(number, 0),
  grid_bounds: v.nullish(segment, null),
  exploring: flag(false),
  stopped: flag(false),
});

const planMesh = v.object({
  px: points,
  triangles: v.array(v.pipe(v.tuple([number, number, number]), v.readonly())),
});

const planNodes = v.object({ map: points });

const sketchSheet = v.object({ size: point, warning: text });

const robot = v.object({
  x: number,
  y: number,
  heading: number,
  sigma_m: v.nullish(number, null),
  sigma_rad: v.nullish(number, null),
  localized: flag(false),
  link: v.optional(v.picklist(['fresh', 'stale', 'lost']), 'lost'),
  heard_ms: v.nullish(number, null),
  speed: v.nullish(number, null),
  stopped: flag(false),
  exploring: flag(false),
  goal: v.nullish(v.string(), null),
  path: v.optional(points, []),
  note: text,
});

const poi = v.object({
  kind: poiKind,
  label: text,
  author: text,
  created_ms: v.optional(number, 0),
  frame: placeFrame,
  p: point,
  map: v.nullish(point, null),
  sigma_m: v.nullish(number, null),
  confidence: v.nullish(number, null),
  reason: text,
  removed: flag(false),
});

const goal = v.object({
  robot: v.string(),
  author: text,
  created_ms: v.optional(number, 0),
  frame: placeFrame,
  p: point,
  heading: v.nullish(number, null),
  map: v.nullish(point, null),
  sigma_m: v.nullish(number, null),
  state: v.picklist(goalStates),
  reason: text,
  remaining_m: v.nullish(number, null),
  eta_s: v.nullish(number, null),
});

const regionKind = v.optional(v.picklist(['room', 'corridor']), 'room');
const label = v.union([number, v.pipe(v.string(), v.transform(Number), v.number(), v.finite())]);

/** `info` is the one part whose objects differ by id. */
export const infoSchemas = { floor, plan_mesh: planMesh, plan_nodes: planNodes, sketch: sketchSheet } as const;

export const partSchemas = {
  layout_walls: v.object({ px: segment, confidence: v.optional(number, 1), by_person: flag(false) }),
  walls: v.object({
    a: point,
    b: point,
    state: v.picklist(wallStates),
    confidence: v.optional(number, 1),
    moved_m: v.nullish(number, null),
  }),
  links: v.object({ p: point, corner: number, state: v.picklist(['kept', 'doubtful', 'rejected']) }),
  robots: robot,
  pois: poi,
  goals: goal,
  strokes: v.object({ kind: strokeKind, author: text, width: v.optional(number, 3), points }),
  sketch_regions: v.object({
    outline: points,
    kind: regionKind,
    pair: v.nullish(label, null),
    confidence: v.nullish(number, null),
  }),
  sketch_gaps: v.object({ a: point, b: point, closed: flag(false) }),
  plan_regions: v.object({ outline: points, kind: regionKind }),
  pairs: v.object({ sketch: label, plan: label, confidence: v.optional(number, 0), verdict }),
  match: v.object({ doubtful: flag(false), margin: v.nullish(number, null), next_pin: v.nullish(label, null) }),
  people: v.object({
    name: text,
    role: v.optional(v.string(), ''),
    mode: text,
    p: v.nullish(point, null),
    seen_ms: v.nullish(number, null),
  }),
  alerts: v.object({ text: v.string(), urgent: flag(false) }),
  anchors: v.object({ px: point, map: point, off_m: v.optional(number), outlier: flag(false) }),
} as const;

export type PartName = keyof typeof partSchemas;
export type PartObject<P extends PartName> = v.InferOutput<(typeof partSchemas)[P]>;
export type Floor = v.InferOutput<typeof floor>;
export type PlanMeshObject = v.InferOutput<typeof planMesh>;
export type SketchSheet = v.InferOutput<typeof sketchSheet>;
export type Robot = PartObject<'robots'>;
export type Poi = PartObject<'pois'>;
export type Goal = PartObject<'goals'>;
export type Wall = PartObject<'walls'>;
export type Stroke = PartObject<'strokes'>;
export type Pair = PartObject<'pairs'>;
export type SketchRegion = PartObject<'sketch_regions'>;

export const partNames = Object.keys(partSchemas) as PartName[];
export const isPartName = (name: string): name is PartName => Object.hasOwn(partSchemas, name);

/** The objects of `set` that fit, by id, and how many did not. */
export function parseTable<P extends PartName>(
  part: P,
  set: Readonly<Record<string, unknown>>,
): { objects: Map<string, PartObject<P>>; dropped: number } {
  const schema = partSchemas[part] as v.GenericSchema<unknown, PartObject<P>>;
  const objects = new Map<string, PartObject<P>>();
  let dropped = 0;
  for (const [id, value] of Object.entries(set)) {
    const parsed = v.safeParse(schema, value, { abortEarly: true });
    if (parsed.success) objects.set(id, parsed.output);
    else dropped++;
  }
  return { objects, dropped };
}
