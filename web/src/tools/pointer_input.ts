/** Connects a canvas to the pointer machine and the view: the thin part that touches the browser. */
import { moveView } from '../geometry/gesture';
import type { Grip } from '../geometry/gesture';
import { screenPoint, type ScreenPoint, type ViewPoint } from '../geometry/points';
import type { Stage } from '../map/stage';
import { type Decision, kIdle, type PointerSample, type PointerState, type Rules, step } from './pointer_machine';

/** What a mode does with decisions that are not about the view. All points are in view coordinates. */
export interface Tool {
  readonly rules: Rules;
  begin?(p: ViewPoint, how: 'draw' | 'drag'): void;
  extend?(p: ViewPoint): void;
  finish?(p: ViewPoint): void;
  discard?(): void;
  tap?(p: ViewPoint, screen: ScreenPoint): void;
  hover?(p: ViewPoint): void;
}

export interface PointerInput {
  readonly penSeen: boolean;
  /** Fingers draw again until a pen is seen the next time. */
  forgetPen(): void;
  dispose(): void;
}

const kWheelStep = 1.0015;

const deviceOf = (type: string): PointerSample['device'] => (type === 'pen' ? 'pen' : type === 'touch' ? 'touch' : 'mouse');

export function attachPointer(target: HTMLElement, stage: Stage, tool: () => Tool, hasGloves: () => boolean, onPenSeen: () => void): PointerInput {
  let state: PointerState = kIdle;
  let grip: Grip | null = null;
  const at = ({ clientX, clientY }: MouseEvent): ScreenPoint => {
    const box = target.getBoundingClientRect();
    return screenPoint(clientX - box.left, clientY - box.top);
  };

  const carryOut = (decision: Decision): void => {
    const now = tool();
    switch (decision.kind) {
      case 'grip':
        grip = { view: stage.view, fingers: decision.fingers };
        return;
      case 'carry':
        if (grip) stage.setView(moveView(grip, decision.fingers, stage.size, stage.limits));
        return;
      case 'begin':
        return now.begin?.(stage.toView(decision.p), decision.how);
      case 'extend':
        return now.extend?.(stage.toView(decision.p));
      case 'finish':
        return now.finish?.(stage.toView(decision.p));
      case 'discard':
        return now.discard?.();
      case 'tap':
        return now.tap?.(stage.toView(decision.p), decision.p);
    }
  };

  const feed = (event: PointerEvent, phase: PointerSample['phase'], p: ScreenPoint): void => {
    const device = deviceOf(event.pointerType);
    const sample: PointerSample = {
      id: event.pointerId,
      phase,
      device,
      p,
      width: event.width,
      timeMs: event.timeStamp,
      secondary: device === 'mouse' && event.button > 0,
    };
    const knewPen = state.penSeen;
    const next = step(state, sample, { ...tool().rules, gloves: hasGloves() });
    state = next.state;
    next.decisions.forEach(carryOut);
    if (!knewPen && state.penSeen) onPenSeen();
  };

  const onDown = (event: PointerEvent): void => {
    // Without this a pen on an iPad writes text and a long press opens a menu.
    event.preventDefault();
    target.setPointerCapture(event.pointerId);
    feed(event, 'down', at(event));
  };
  const onMove = (event: PointerEvent): void => {
    if (!state.contacts.has(event.pointerId)) {
      if (event.pointerType === 'pen') state = { ...state, penSeen: true, lastPenMs: event.timeStamp };
      tool().hover?.(stage.toView(at(event)));
      return;
    }
    // A pen reports faster than the screen paints; the points in between make the curve.
    const coalesced = event.getCoalescedEvents?.() ?? [];
    for (const each of coalesced.length > 0 ? coalesced : [event]) feed(event, 'move', at(each));
  };
  const onUp = (event: PointerEvent): void => feed(event, 'up', at(event));
  const onCancel = (event: PointerEvent): void => feed(event, 'cancel', at(event));
  const onWheel = (event: WheelEvent): void => {
    event.preventDefault();
    stage.zoom(kWheelStep ** -event.deltaY, at(event));
  };
  const onMenu = (event: Event): void => event.preventDefault();

  const controller = new AbortController();
  const { signal } = controller;
  target.addEventListener('pointerdown', onDown, { signal });
  target.addEventListener('pointermove', onMove, { signal });
  target.addEventListener('pointerup', onUp, { signal });
  target.addEventListener('pointercancel', onCancel, { signal });
  target.addEventListener('wheel', onWheel, { signal, passive: false });
  target.addEventListener('contextmenu', onMenu, { signal });
  return {
    get penSeen() {
      return state.penSeen;
    },
    forgetPen: () => {
      state = { ...state, penSeen: false };
    },
    dispose: () => controller.abort(),
  };
}
