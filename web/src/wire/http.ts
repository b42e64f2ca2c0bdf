/** Answers of the HTTP side (docs/wire.md, section 1). */
import * as v from 'valibot';
import { isPartName, role } from './parts';

const number = v.pipe(v.number(), v.finite());
const pair = v.pipe(v.tuple([number, number]), v.readonly());

const failure = v.object({ error: v.object({ code: v.string(), message: v.string() }) });
const pairing = v.object({ token: v.string(), device: v.string(), role, name: v.string() });
const upload = v.object({ plan_id: v.string(), width: number, height: number, warnings: v.optional(v.array(v.string()), []) });
const photo = v.object({
  width: number,
  height: number,
  strokes: v.array(v.object({ points: v.array(pair), kind: v.optional(v.picklist(['wall', 'door', 'note']), 'wall') })),
});
const logEvent = v.object({
  seq: number,
  time_ms: number,
  device: v.optional(v.string(), ''),
  person: v.optional(v.string(), ''),
  role: v.optional(v.string(), ''),
  name: v.string(),
  data: v.optional(v.unknown(), {}),
  outcome: v.optional(v.string(), ''),
});
const way = v.object({ path: v.array(pair), length_m: v.optional(number, 0), unseen_m: v.optional(number, 0), reason: v.string() });
const eventPage = v.object({ events: v.array(v.unknown()), next: v.nullish(number, null) });

export type Pairing = v.InferOutput<typeof pairing>;
export type Upload = v.InferOutput<typeof upload>;
export type SketchPhoto = v.InferOutput<typeof photo>;
/** Without points there is none, and `reason` says why. */
export type Way = v.InferOutput<typeof way>;
export type LogEvent = v.InferOutput<typeof logEvent>;

const parser =
  <T>(schema: v.GenericSchema<unknown, T>) =>
  (value: unknown): T | undefined => {
    const parsed = v.safeParse(schema, value, { abortEarly: true });
    return parsed.success ? parsed.output : undefined;
  };

export const parseFailure = parser(failure);
export const parsePairing = parser(pairing);
export const parseDone = parser(v.object({ type: v.literal('done'), seq: number }));
export const parseUpload = parser(upload);
export const parseWay = parser(way);
export const parseSketchPhoto = parser(photo);

export function parseEventPage(value: unknown): { events: LogEvent[]; next: number | null } | undefined {
  const page = parser(eventPage)(value);
  if (!page) return undefined;
  return { events: page.events.map(parser(logEvent)).filter((event) => event !== undefined), next: page.next };
}

/** The state parts after some event, as tables by part. Parts that this page does not know are left out. */
export function parseSnapshot(value: unknown): Record<string, Record<string, unknown>> | undefined {
  const table = v.record(v.string(), v.unknown());
  const past = parser(v.object({ parts: v.record(v.string(), table) }))(value);
  if (!past) return undefined;
  return Object.fromEntries(Object.entries(past.parts).filter(([name]) => name === 'info' || isPartName(name)));
}
