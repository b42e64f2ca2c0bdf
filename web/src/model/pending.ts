/**
 * What this person did that the server has not shown back yet, laid over the world: a stroke stays where the pen left it,
 * with or without a link. The entry goes when the server's own object arrives, or when it refused.
 */
import type { Command } from '../wire/commands';
import type { Poi, Stroke } from '../wire/parts';
import type { Tables, World } from './world';

export interface PendingCommand {
  readonly id: string;
  readonly command: Command;
  readonly createdMs: number;
}

export function withPending(world: World, pending: readonly PendingCommand[], author: string): World {
  if (pending.length === 0) return world;
  const strokes = new Map(world.tables.strokes);
  const pois = new Map(world.tables.pois);
  for (const { command, createdMs } of pending) {
    overlayStrokes(strokes, world.tables.strokes, command, author);
    overlayPois(pois, world.tables.pois, command, author, createdMs);
  }
  const tables: Tables = { ...world.tables, strokes, pois };
  return { ...world, tables };
}

function overlayStrokes(strokes: Map<string, Stroke>, known: ReadonlyMap<string, Stroke>, command: Command, author: string): void {
  if (command.name === 'clear_sketch') strokes.clear();
  if (command.name === 'erase_stroke' && !command.data.restore) strokes.delete(command.data.stroke_id);
  if (command.name === 'erase_stroke' && command.data.restore) {
    const stroke = known.get(command.data.stroke_id);
    if (stroke) strokes.set(command.data.stroke_id, stroke);
  }
  if (command.name !== 'add_stroke') return;
  const { stroke_id, kind, width, points } = command.data;
  strokes.set(stroke_id, { kind, width, author, points: [...points] });
}

function overlayPois(
  pois: Map<string, Poi>,
  known: ReadonlyMap<string, Poi>,
  command: Command,
  author: string,
  createdMs: number,
): void {
  if (command.name === 'remove_poi') pois.delete(command.data.poi_id);
  if (command.name !== 'place_poi') return;
  const { poi_id, kind, frame, p, label } = command.data;
  const before = known.get(poi_id);
  const onMap = frame === 'map';
  pois.set(poi_id, {
    kind,
    label,
    frame,
    p,
    author: before?.author ?? author,
    created_ms: before?.created_ms ?? createdMs,
    map: onMap ? p : (before?.map ?? null),
    sigma_m: onMap ? 0 : (before?.sigma_m ?? null),
    confidence: before?.confidence ?? null,
    reason: before?.reason ?? '',
    removed: false,
  });
}

/** Does the world show the effect of an acknowledged command already? Then its overlay is no longer needed. */
export function isReflected(world: World, command: Command): boolean {
  switch (command.name) {
    case 'add_stroke':
      return world.tables.strokes.has(command.data.stroke_id);
    case 'erase_stroke':
      return world.tables.strokes.has(command.data.stroke_id) === command.data.restore;
    case 'place_poi': {
      const poi = world.tables.pois.get(command.data.poi_id);
      return !!poi && poi.label === command.data.label && poi.p[0] === command.data.p[0] && poi.p[1] === command.data.p[1];
    }
    case 'remove_poi': {
      const poi = world.tables.pois.get(command.data.poi_id);
      return !poi || poi.removed;
    }
    default:
      return true;
  }
}
