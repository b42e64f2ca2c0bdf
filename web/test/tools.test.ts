import { describe, expect, test } from 'vitest';
import { screenPoint, viewPoint, type SketchPx } from '../src/geometry/points';
import { touchedStrokes } from '../src/tools/eraser';
import { hits, nearest } from '../src/tools/hit';
import { InkStream } from '../src/tools/ink_stream';

test('the eraser takes whole strokes that it touches, and no others', () => {
  const strokes = new Map([
    ['near', { points: [[0, 0], [100, 0]] as [number, number][], width: 4 }],
    ['far', { points: [[0, 50], [100, 50]] as [number, number][], width: 4 }],
    ['dot', { points: [[50, 8]] as [number, number][], width: 4 }],
  ]);
  expect([...touchedStrokes([[50, 5]], strokes, 4)].sort()).toEqual(['dot', 'near']);
  expect(touchedStrokes([[50, 25]], strokes, 4).size).toBe(0);
});

describe('a tap', () => {
  const toScreen = ([x, y]: readonly [number, number]) => screenPoint(10 * x, 10 * y);
  const targets = [{ p: viewPoint(1, 1), what: 'a' }, { p: viewPoint(2, 1), what: 'b' }, { p: viewPoint(50, 50), what: 'c' }];
  test('finds everything within a gloved finger, nearest first', () => {
    expect(hits(screenPoint(18, 10), targets, toScreen)).toEqual(['b', 'a']);
    expect(nearest(screenPoint(12, 10), targets, toScreen)).toBe('a');
  });
  test('finds nothing where nothing is', () => {
    expect(nearest(screenPoint(200, 200), targets, toScreen)).toBeUndefined();
  });
});

test('live ink goes out at most ten times a second and misses no point', () => {
  const sent: [string, number][] = [];
  const stream = new InkStream((id, points) => sent.push([id, points.length]));
  stream.begin('s');
  for (let ms = 0; ms < 1000; ms += 10) stream.add([ms, 0] as SketchPx, ms);
  expect(sent.length).toBeLessThanOrEqual(10);
  expect(sent.every(([id]) => id === 's')).toBe(true);
  expect(sent.reduce((sum, [, count]) => sum + count, 0)).toBeGreaterThanOrEqual(90);
});
