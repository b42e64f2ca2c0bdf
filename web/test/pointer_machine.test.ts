import { describe, expect, test } from 'vitest';
import { screenPoint } from '../src/geometry/points';
import { type Decision, kIdle, type PointerSample, type PointerState, type Rules, step } from '../src/tools/pointer_machine';
import { between, randomSource } from './support/random';

const ink: Rules = { wants: () => 'draw', fingerDraws: 'until pen' };
const look: Rules = { wants: () => 'none', fingerDraws: 'never' };

/** A scripted hand: `down(1, 'pen', 10, 10, 0)` and so on; remembers every decision. */
class Hand {
  state: PointerState = kIdle;
  said: Decision[] = [];
  readonly rules: Rules;
  constructor(rules: Rules) {
    this.rules = rules;
  }
  #feed(sample: Omit<PointerSample, 'width'> & { width?: number }): this {
    const { state, decisions } = step(this.state, { width: 1, ...sample }, this.rules);
    this.state = state;
    this.said.push(...decisions);
    return this;
  }
  down(id: number, device: PointerSample['device'], x: number, y: number, timeMs: number, width = 1): this {
    return this.#feed({ id, phase: 'down', device, p: screenPoint(x, y), timeMs, width });
  }
  move(id: number, device: PointerSample['device'], x: number, y: number, timeMs: number): this {
    return this.#feed({ id, phase: 'move', device, p: screenPoint(x, y), timeMs });
  }
  up(id: number, device: PointerSample['device'], x: number, y: number, timeMs: number): this {
    return this.#feed({ id, phase: 'up', device, p: screenPoint(x, y), timeMs });
  }
  cancel(id: number, device: PointerSample['device'], timeMs: number): this {
    return this.#feed({ id, phase: 'cancel', device, p: screenPoint(0, 0), timeMs });
  }
  get kinds(): string[] {
    return this.said.map((decision) => decision.kind);
  }
  /** Strokes that were begun and not taken back. */
  get strokes(): number {
    const count = (kind: Decision['kind']): number => this.said.filter((decision) => decision.kind === kind).length;
    return count('begin') - count('discard');
  }
}

describe('a pen', () => {
  test('draws at once', () => {
    const hand = new Hand(ink).down(1, 'pen', 10, 10, 0).move(1, 'pen', 20, 20, 8).up(1, 'pen', 30, 30, 16);
    expect(hand.kinds).toEqual(['begin', 'extend', 'finish']);
  });
  test('leaves a dot where it only touched', () => {
    expect(new Hand(ink).down(1, 'pen', 10, 10, 0).up(1, 'pen', 10, 10, 30).kinds).toEqual(['begin', 'finish']);
  });
  test('moves the map where no tool wants it', () => {
    const hand = new Hand(look).down(1, 'pen', 10, 10, 0).move(1, 'pen', 60, 10, 20);
    expect(hand.kinds).toEqual(['grip', 'carry']);
  });
});

describe('a finger', () => {
  test('draws until a pen was seen, after a short hold', () => {
    const hand = new Hand(ink).down(1, 'touch', 10, 10, 0).move(1, 'touch', 14, 10, 30);
    expect(hand.kinds).toEqual([]);
    hand.move(1, 'touch', 40, 10, 70).up(1, 'touch', 50, 10, 120);
    expect(hand.kinds).toEqual(['begin', 'extend', 'finish']);
    expect(hand.said[0]).toMatchObject({ p: [10, 10] });
  });
  test('leaves a dot when it taps', () => {
    expect(new Hand(ink).down(1, 'touch', 10, 10, 0).up(1, 'touch', 10, 10, 40).kinds).toEqual(['begin', 'finish']);
  });
  test('moves the map once a pen was seen', () => {
    const hand = new Hand(ink).down(1, 'pen', 0, 0, 0).up(1, 'pen', 5, 5, 20);
    hand.said = [];
    hand.down(2, 'touch', 100, 100, 2000).move(2, 'touch', 150, 100, 2050).up(2, 'touch', 150, 100, 2100);
    expect(hand.kinds).toEqual(['grip', 'carry']);
  });
  test('taps when it neither moved nor stayed', () => {
    expect(new Hand(look).down(1, 'touch', 10, 10, 0).move(1, 'touch', 15, 12, 40).up(1, 'touch', 15, 12, 90).kinds).toEqual(['grip', 'tap']);
    expect(new Hand(look).down(1, 'touch', 10, 10, 0).up(1, 'touch', 10, 10, 900).kinds).toEqual(['grip']);
  });
  test('takes hold of a handle whatever the pen did', () => {
    const hand = new Hand({ wants: () => 'drag', fingerDraws: 'until pen' }).down(1, 'pen', 0, 0, 0).up(1, 'pen', 0, 0, 10);
    hand.said = [];
    hand.down(2, 'touch', 9, 9, 2000).move(2, 'touch', 30, 9, 2010);
    expect(hand.said[0]).toMatchObject({ kind: 'begin', how: 'drag' });
  });
});

describe('two fingers', () => {
  test('move the map and leave no stroke', () => {
    const hand = new Hand(ink).down(1, 'touch', 10, 10, 0).down(2, 'touch', 90, 10, 40).move(1, 'touch', 0, 10, 80);
    expect(hand.kinds).toEqual(['grip', 'carry']);
    expect(hand.strokes).toBe(0);
  });
  test('take back a stroke younger than 120 ms', () => {
    const hand = new Hand(ink).down(1, 'touch', 10, 10, 0).move(1, 'touch', 40, 10, 70).down(2, 'touch', 90, 10, 100);
    expect(hand.kinds).toEqual(['begin', 'extend', 'discard', 'grip']);
  });
  test('do not disturb a stroke that is under way', () => {
    const hand = new Hand(ink).down(1, 'touch', 10, 10, 0).move(1, 'touch', 80, 10, 200).down(2, 'touch', 90, 90, 400);
    hand.move(1, 'touch', 120, 10, 420).up(2, 'touch', 90, 90, 430).up(1, 'touch', 130, 10, 500);
    expect(hand.kinds).toEqual(['begin', 'extend', 'extend', 'finish']);
  });
  test('go on with one when the other lifts', () => {
    const hand = new Hand(look).down(1, 'touch', 10, 10, 0).down(2, 'touch', 90, 10, 10).move(2, 'touch', 120, 10, 30).up(2, 'touch', 120, 10, 50);
    expect(hand.said.at(-1)).toEqual({ kind: 'grip', fingers: [[10, 10]] });
  });
});

describe('a palm', () => {
  test('that is wide is ignored, before or after the pen', () => {
    const hand = new Hand(ink).down(1, 'touch', 300, 300, 0, 90).move(1, 'touch', 310, 300, 80).up(1, 'touch', 310, 300, 400);
    expect(hand.kinds).toEqual([]);
  });
  test('that lands first, narrow, loses to the pen that follows', () => {
    const hand = new Hand(ink).down(1, 'touch', 300, 300, 0).down(2, 'pen', 200, 200, 30).move(2, 'pen', 210, 210, 40);
    hand.move(1, 'touch', 305, 300, 90).up(2, 'pen', 220, 220, 200).up(1, 'touch', 305, 300, 220);
    expect(hand.kinds).toEqual(['begin', 'extend', 'finish']);
    expect(hand.said[0]).toMatchObject({ p: [200, 200] });
  });
  test('that began a stroke has it taken back by the pen', () => {
    const hand = new Hand(ink).down(1, 'touch', 300, 300, 0).move(1, 'touch', 330, 300, 70).down(2, 'pen', 200, 200, 90);
    expect(hand.kinds).toEqual(['begin', 'extend', 'discard', 'begin']);
  });
  test('that touches while the pen writes, or just after, does nothing', () => {
    const hand = new Hand(ink).down(1, 'pen', 0, 0, 0).down(2, 'touch', 50, 50, 100).up(2, 'touch', 50, 50, 150).up(1, 'pen', 9, 9, 300);
    hand.down(3, 'touch', 60, 60, 700).move(3, 'touch', 90, 60, 790).up(3, 'touch', 90, 60, 790);
    expect(hand.kinds).toEqual(['begin', 'finish']);
  });
  test('never leaves a stroke, and the pen never loses one, in a thousand random hands', () => {
    const random = randomSource(11);
    for (let i = 0; i < 1000; i++) {
      const hand = new Hand(ink);
      const palmAt = between(random, 0, 50);
      const penAt = palmAt + between(random, 0, 59);
      const width = random() < 0.5 ? 90 : 20;
      hand.down(1, 'touch', 300, 300, palmAt, width).down(2, 'pen', 200, 200, penAt);
      for (let k = 1; k <= 5; k++) {
        hand.move(random() < 0.5 ? 1 : 2, random() < 0.5 ? 'touch' : 'pen', between(random, 0, 400), between(random, 0, 400), penAt + 16 * k);
      }
      hand.up(2, 'pen', 220, 220, penAt + 120);
      if (random() < 0.5) hand.up(1, 'touch', 300, 300, penAt + 150);
      else hand.cancel(1, 'touch', penAt + 150);
      expect(hand.strokes).toBe(1);
      expect(hand.kinds.filter((kind) => kind === 'finish')).toHaveLength(1);
    }
  });
});

test('a cancelled contact takes its stroke back', () => {
  expect(new Hand(ink).down(1, 'pen', 0, 0, 0).cancel(1, 'pen', 20).kinds).toEqual(['begin', 'discard']);
});
