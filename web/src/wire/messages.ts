/** Text frames of `/api/live`, subprotocol smokemap.v1: what the server says, checked; what the browser says, typed. */
import * as v from 'valibot';
import type { Xy } from '../geometry/points';
import type { Command } from './commands';
import { role } from './parts';

export const kProtocol = 'smokemap.v1';

const number = v.pipe(v.number(), v.finite());

const serverMessage = v.variant('type', [
  v.object({
    type: v.literal('welcome'),
    device: v.string(),
    role,
    name: v.string(),
    epoch: number,
    seq: number,
    server_ms: number,
    tile_size: v.optional(number, 128),
    resolution_m: v.optional(number, 0.05),
  }),
  v.object({
    type: v.literal('delta'),
    part: v.string(),
    rev: v.optional(number, 0),
    reset: v.optional(v.boolean(), false),
    set: v.optional(v.record(v.string(), v.unknown()), {}),
    del: v.optional(v.array(v.string()), []),
  }),
  v.object({ type: v.literal('done'), id: v.string(), seq: v.optional(number, 0) }),
  v.object({
    type: v.literal('refused'),
    id: v.string(),
    code: v.optional(v.string(), ''),
    message: v.optional(v.string(), ''),
    seq: v.nullish(number, null),
  }),
  v.object({ type: v.literal('pong'), t: number, server_ms: number }),
  v.object({
    type: v.literal('ink'),
    device: v.string(),
    name: v.optional(v.string(), ''),
    stroke_id: v.string(),
    points: v.array(v.pipe(v.tuple([number, number]), v.readonly())),
  }),
  v.object({ type: v.literal('bye'), reason: v.optional(v.string(), '') }),
]);

export type ServerMessage = v.InferOutput<typeof serverMessage>;
export type Message<T extends ServerMessage['type']> = Extract<ServerMessage, { type: T }>;

/** undefined for anything that is not a message of this protocol: the caller drops it and says so. */
export function parseServerMessage(text: string): ServerMessage | undefined {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return undefined;
  }
  const parsed = v.safeParse(serverMessage, value, { abortEarly: true });
  return parsed.success ? parsed.output : undefined;
}

/** Where the browser looks, in map: tiles there come first. */
export interface View {
  readonly x: number;
  readonly y: number;
  readonly radius: number;
}

export type ClientMessage =
  | {
      readonly type: 'hello';
      readonly token: string;
      readonly version: 1;
      readonly epoch: number;
      readonly seq: number;
      readonly view?: View;
      /** Revision still held per part: the server goes on from there if it is the same run. */
      readonly parts?: Readonly<Record<string, number>>;
    }
  | ({ readonly type: 'view' } & View)
  | { readonly type: 'ack'; readonly seq: number }
  | ({ readonly type: 'command'; readonly id: string; readonly expires_ms?: number } & Command)
  | { readonly type: 'ping'; readonly t: number }
  | { readonly type: 'presence'; readonly mode: string; readonly p: Xy | null }
  | { readonly type: 'ink'; readonly stroke_id: string; readonly points: readonly Xy[] };

export const encode = (message: ClientMessage): string => JSON.stringify(message);
