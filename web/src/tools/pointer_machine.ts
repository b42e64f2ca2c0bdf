/**
 * What a contact means. Pure: events in, decisions out, the clock comes with the events.
 *
 *  - A pen always works the tool. Once a pen was seen, one finger moves the map; until then a finger works the tool.
 *  - Two fingers move, scale and turn. A second finger within 120 ms takes back a stroke that the first began.
 *  - A contact wider than 60 px, or any touch near the time of a pen (500 ms), is a palm: ignored.
 *  - A finger's stroke is held back for 60 ms, because a palm often lands just before its pen.
 *  - What moved less than the slop within 400 ms is a tap.
 */
import { distance, type ScreenPoint } from '../geometry/points';

export interface PointerSample {
  readonly id: number;
  readonly phase: 'down' | 'move' | 'up' | 'cancel';
  readonly device: 'pen' | 'touch' | 'mouse';
  readonly p: ScreenPoint;
  /** Contact width in CSS pixels; 1 for a mouse. */
  readonly width: number;
  readonly timeMs: number;
  /** Mouse: another button than the first. */
  readonly secondary?: boolean;
}

export interface Rules {
  /** Does the tool want this contact? `draw`: as ink; `drag`: it took hold of a handle; `none`: the map may have it. */
  readonly wants: (p: ScreenPoint) => 'draw' | 'drag' | 'none';
  readonly fingerDraws: 'until pen' | 'always' | 'never';
  /** Gloves are wide and slip: a tap may move further, and only a wider contact is a palm. */
  readonly gloves?: boolean;
}

export type Decision =
  | { readonly kind: 'begin'; readonly how: 'draw' | 'drag'; readonly p: ScreenPoint }
  | { readonly kind: 'extend'; readonly p: ScreenPoint }
  | { readonly kind: 'finish'; readonly p: ScreenPoint }
  | { readonly kind: 'discard' }
  | { readonly kind: 'tap'; readonly p: ScreenPoint }
  | { readonly kind: 'grip'; readonly fingers: readonly ScreenPoint[] }
  | { readonly kind: 'carry'; readonly fingers: readonly ScreenPoint[] };

interface Contact {
  readonly device: PointerSample['device'];
  readonly from: ScreenPoint;
  readonly sinceMs: number;
  readonly p: ScreenPoint;
  readonly moved: boolean;
  /** held: a finger that may become ink. ignored: a palm, or a finger that arrived beside one. */
  readonly role: 'held' | 'work' | 'gesture' | 'ignored';
  readonly how: 'draw' | 'drag';
}

export interface PointerState {
  readonly contacts: ReadonlyMap<number, Contact>;
  readonly penSeen: boolean;
  readonly lastPenMs: number;
}

export const kPalmWidthPx = 60;
export const kPenQuietMs = 500;
export const kHoldMs = 60;
export const kTakeBackMs = 120;
const kTapMs = 400;
const kSlopPx = 12;
export const kGloveSlopPx = 24;
export const kGlovePalmPx = 110;

export const kIdle: PointerState = { contacts: new Map(), penSeen: false, lastPenMs: -Infinity };

interface Step {
  readonly state: PointerState;
  readonly decisions: readonly Decision[];
}

const stay = (state: PointerState, ...decisions: Decision[]): Step => ({ state, decisions });

function withContact(state: PointerState, id: number, contact: Contact | undefined): PointerState {
  const contacts = new Map(state.contacts);
  if (contact) contacts.set(id, contact);
  else contacts.delete(id);
  return { ...state, contacts };
}

const gestureFingers = (state: PointerState): ScreenPoint[] =>
  [...state.contacts.values()].filter((contact) => contact.role === 'gesture').map((contact) => contact.p);

export function step(state: PointerState, sample: PointerSample, rules: Rules): Step {
  const timed = sample.device === 'pen' ? { ...state, penSeen: true, lastPenMs: sample.timeMs } : state;
  switch (sample.phase) {
    case 'down':
      return onDown(timed, sample, rules);
    case 'move':
      return onMove(timed, sample, rules);
    case 'up':
      return onUp(timed, sample);
    case 'cancel':
      return onCancel(timed, sample);
  }
}

const isPalm = (state: PointerState, { device, width, timeMs }: PointerSample, { gloves }: Rules): boolean =>
  device === 'touch' && (width > (gloves ? kGlovePalmPx : kPalmWidthPx) || timeMs - state.lastPenMs < kPenQuietMs);

function onDown(state: PointerState, sample: PointerSample, rules: Rules): Step {
  const { id, p, device, timeMs } = sample;
  const wanted = sample.secondary ? 'none' : rules.wants(p);
  const fresh = { device, from: p, sinceMs: timeMs, p, moved: false, how: wanted === 'drag' ? 'drag' : 'draw' } as const;
  if (isPalm(state, sample, rules)) return stay(withContact(state, id, { ...fresh, role: 'ignored' }));
  if (device === 'pen') return penDown(state, id, { ...fresh, role: wanted === 'none' ? 'gesture' : 'work' });
  const working = [...state.contacts].find(([, contact]) => contact.role === 'work' || contact.role === 'held');
  if (working) return secondFinger(state, working, id, fresh, timeMs);
  const gesturing = gestureFingers(state).length > 0;
  const fingerMay = wanted === 'drag' || device === 'mouse' || rules.fingerDraws === 'always' || (rules.fingerDraws === 'until pen' && !state.penSeen);
  if (wanted === 'none' || gesturing || !fingerMay) return joinGesture(state, id, { ...fresh, role: 'gesture' });
  if (device === 'touch' && wanted === 'draw') return stay(withContact(state, id, { ...fresh, role: 'held' }));
  return stay(withContact(state, id, { ...fresh, role: 'work' }), { kind: 'begin', how: fresh.how, p });
}

/** The pen wins over every finger that is already down: their strokes are taken back, their gestures end. */
function penDown(state: PointerState, id: number, contact: Contact): Step {
  const wasDrawing = [...state.contacts.values()].some((other) => other.role === 'work');
  const contacts = new Map([...state.contacts].map(([key, other]) => [key, { ...other, role: 'ignored' } as Contact]));
  contacts.set(id, contact);
  const begin: Decision[] =
    contact.role === 'work' ? [{ kind: 'begin', how: contact.how, p: contact.p }] : [{ kind: 'grip', fingers: [contact.p] }];
  return { state: { ...state, contacts }, decisions: wasDrawing ? [{ kind: 'discard' }, ...begin] : begin };
}

function secondFinger(
  state: PointerState,
  [otherId, other]: readonly [number, Contact],
  id: number,
  fresh: Omit<Contact, 'role'>,
  timeMs: number,
): Step {
  const young = timeMs - other.sinceMs < kTakeBackMs || other.role === 'held' || !other.moved;
  if (other.device === 'pen' || other.how === 'drag' || !young) return stay(withContact(state, id, { ...fresh, role: 'ignored' }));
  const both = withContact(withContact(state, otherId, { ...other, role: 'gesture' }), id, { ...fresh, role: 'gesture', moved: true });
  const grip: Decision = { kind: 'grip', fingers: gestureFingers(both) };
  return other.role === 'work' ? stay(both, { kind: 'discard' }, grip) : stay(both, grip);
}

function joinGesture(state: PointerState, id: number, contact: Contact): Step {
  const next = withContact(state, id, contact);
  return stay(next, { kind: 'grip', fingers: gestureFingers(next) });
}

function onMove(state: PointerState, { id, p, timeMs }: PointerSample, { gloves }: Rules): Step {
  const contact = state.contacts.get(id);
  if (!contact) return stay(state);
  const moved = contact.moved || distance(contact.from, p) > (gloves ? kGloveSlopPx : kSlopPx);
  const next: Contact = { ...contact, p, moved };
  if (contact.role === 'held') {
    const ripe = timeMs - contact.sinceMs >= kHoldMs;
    const kept = withContact(state, id, ripe ? { ...next, role: 'work' } : { ...next, p });
    return ripe ? stay(kept, { kind: 'begin', how: 'draw', p: contact.from }, { kind: 'extend', p }) : stay(kept);
  }
  const after = withContact(state, id, next);
  if (contact.role === 'work') return stay(after, { kind: 'extend', p });
  if (contact.role === 'gesture') {
    const fingers = gestureFingers(after);
    // A single finger must leave the slop first, or every tap would nudge the map.
    return fingers.length > 1 || moved ? stay(after, { kind: 'carry', fingers }) : stay(after);
  }
  return stay(after);
}

function onUp(state: PointerState, { id, p, timeMs }: PointerSample): Step {
  const contact = state.contacts.get(id);
  const after = withContact(state, id, undefined);
  if (!contact) return stay(after);
  const isTap = !contact.moved && timeMs - contact.sinceMs < kTapMs;
  switch (contact.role) {
    case 'ignored':
      return stay(after);
    case 'held':
      return stay(after, { kind: 'begin', how: 'draw', p: contact.from }, { kind: 'finish', p });
    case 'work':
      return stay(after, { kind: 'finish', p });
    case 'gesture': {
      const left = gestureFingers(after);
      if (left.length > 0) return stay(after, { kind: 'grip', fingers: left });
      return isTap ? stay(after, { kind: 'tap', p }) : stay(after);
    }
  }
}

function onCancel(state: PointerState, { id }: PointerSample): Step {
  const contact = state.contacts.get(id);
  const after = withContact(state, id, undefined);
  if (contact?.role === 'work') return stay(after, { kind: 'discard' });
  const left = gestureFingers(after);
  return contact?.role === 'gesture' && left.length > 0 ? stay(after, { kind: 'grip', fingers: left }) : stay(after);
}
