/** What the device keeps beside the last state: where the link goes on, and how old the state is. */
import * as v from 'valibot';

const number = v.pipe(v.number(), v.finite());

const savedHead = v.object({
  format: v.literal(1),
  epoch: number,
  seq: number,
  revisions: v.record(v.string(), number),
  resolutionM: number,
  /** This device's clock when the server was last heard. */
  heardMs: number,
  /** Server's clock minus this device's. */
  clockOffsetMs: number,
});

export type SavedHead = v.InferOutput<typeof savedHead>;

export const parseSavedHead = (value: unknown): SavedHead | undefined => {
  const parsed = v.safeParse(savedHead, value, { abortEarly: true });
  return parsed.success ? parsed.output : undefined;
};
