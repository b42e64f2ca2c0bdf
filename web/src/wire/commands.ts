/** What people do. Every command is idempotent; its id is made here, so sending one twice changes nothing. */
import type { LayoutPx, MapPoint, SketchPx, Xy } from '../geometry/points';
import type { LayoutDocument } from './layout_document';
import type { PlaceFrame, PoiKind, Role, StrokeKind, Verdict } from './parts';

export interface CommandData {
  set_layout: { plan_id: string; layout: LayoutDocument };
  set_start: { robot: string; px: LayoutPx; heading: number };
  add_anchor: { id: string; px: LayoutPx; map: MapPoint };
  remove_anchor: { id: string };
  judge_wall: { wall: number; verdict: 'none' | 'gone' | 'there' };
  /** In metres; null takes it back. */
  measure_wall: { wall: number; length: number | null };
  pin_corner: { corner: number; map: MapPoint | null };
  add_stroke: { stroke_id: string; kind: StrokeKind; width: number; points: readonly SketchPx[] };
  erase_stroke: { stroke_id: string; restore: boolean };
  clear_sketch: Record<string, never>;
  set_sketch_sheet: { width: number; height: number };
  /** By a point inside each room: labels change with every stroke, places do not. `proposed` takes a verdict back. */
  judge_pair: { sketch_px: SketchPx; plan_px: LayoutPx; verdict: Verdict };
  place_poi: { poi_id: string; kind: PoiKind; frame: PlaceFrame; p: Xy; label: string };
  remove_poi: { poi_id: string };
  set_goal: { goal_id: string; robot: string; frame: PlaceFrame; p: Xy; heading: number | null };
  cancel_goal: { goal_id: string };
  emergency_stop: { robot: string; engaged: boolean };
  set_exploring: { robot: string; exploring: boolean };
}

export type CommandName = keyof CommandData;
export type Command = { [N in CommandName]: { readonly name: N; readonly data: CommandData[N] } }[CommandName];

const kCommanderOnly: ReadonlySet<CommandName> = new Set<CommandName>([
  'set_layout', 'set_start', 'add_anchor', 'remove_anchor', 'judge_wall', 'measure_wall', 'pin_corner', 'set_goal', 'cancel_goal', 'set_exploring',
]);

/** What the server would refuse anyway, known here so that the control can say why it is off. */
export function mayCommand(role: Role, command: Command): boolean {
  if (command.name === 'emergency_stop') return command.data.engaged || role === 'commander';
  if (kCommanderOnly.has(command.name)) return role === 'commander';
  return role !== 'observer';
}

/**
 * How long a command waits for a link before it must not be carried out any more, in ms. A drive that somebody asked for
 * ten minutes ago must not begin now; what people drew or marked, and a stop, never lapses.
 */
export function timeToLive(command: Command): number | undefined {
  switch (command.name) {
    case 'set_goal':
    case 'set_exploring':
      return 5_000;
    case 'emergency_stop':
      return command.data.engaged ? undefined : 5_000;
    default:
      return undefined;
  }
}
