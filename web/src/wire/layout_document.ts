/** What reading a plan gives, and what `set_layout` sends back after a person corrected it. Pixels of the rectified picture, y down. */
import * as v from 'valibot';

const number = v.pipe(v.number(), v.finite());
const pair = v.pipe(v.tuple([number, number]), v.readonly());
const segment = v.pipe(v.tuple([number, number, number, number]), v.readonly());

/** Fields that this page does not touch (signs, homography, ...) travel through it unchanged. */
const layoutDocument = v.looseObject({
  size: pair,
  walls: v.array(v.pipe(v.tuple([number, number, number, number, number]), v.readonly())),
  wall_confidence: v.optional(v.array(number), []),
  wall_by_person: v.optional(v.array(v.boolean()), []),
  doors: v.optional(v.array(segment), []),
  door_kinds: v.optional(v.array(v.picklist(['door', 'window', 'passage'])), []),
  door_confidence: v.optional(v.array(number), []),
  corners: v.optional(v.array(pair), []),
  wall_corners: v.optional(v.array(pair), []),
  metres_per_pixel: v.nullish(number, null),
  scale_sigma: v.nullish(number, null),
  scale_by_person: v.optional(v.boolean(), false),
  rectified: v.optional(v.string()),
  /** Parts of the sheet that could be the plan, best first: the walls are those of the chosen one. */
  drawings: v.optional(v.array(v.object({ box: segment, score: number, chosen: v.boolean() })), []),
  /** Photo to rectified picture; the identity where the picture was read as it is. */
  homography: v.nullish(v.array(number), null),
  sheet_corners: v.nullish(v.array(pair), null),
  you_are_here: v.nullish(pair, null),
  warnings: v.optional(v.array(v.string()), []),
});

export type LayoutDocument = v.InferOutput<typeof layoutDocument>;

export const parseLayoutDocument = (value: unknown): LayoutDocument | undefined => {
  const parsed = v.safeParse(layoutDocument, value, { abortEarly: true });
  return parsed.success ? parsed.output : undefined;
};

/** The answer to `POST /api/plans/{id}/read`: the document, which names the picture that it lies on. */
export function parseReadAnswer(value: unknown): { layout: LayoutDocument; rectified: string } | undefined {
  const layout = parseLayoutDocument(value);
  return layout?.rectified === undefined ? undefined : { layout, rectified: layout.rectified };
}
