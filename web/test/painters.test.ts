import { beforeAll, describe, expect, test } from 'vitest';
import { FitPainter } from '../src/map/fit_painter';
import { MarksPainter, poiColour } from '../src/map/marks_painter';
import { OverlayPainter } from '../src/map/overlay_painter';
import { kDark, kLight } from '../src/map/palette';
import { PicturePainter } from '../src/map/picture_painter';
import { PlanWallsPainter } from '../src/map/plan_walls_painter';
import { RegionsPainter } from '../src/map/regions_painter';
import { SheetPainter } from '../src/map/sheet_painter';
import { LiveInkPainter, type ShownStroke, StrokesPainter } from '../src/map/strokes_painter';
import { kWallStyles, WallsPainter } from '../src/map/walls_painter';
import { poiKinds, type Robot, type Wall, wallStates, type WallState } from '../src/wire/parts';
import { type FakePath, painted, withoutBrowser } from './support/canvas';

beforeAll(withoutBrowser);

const wall = (state: WallState, x = 0): Wall => ({ a: [x, 0], b: [x + 2, 0], state, confidence: 1, moved_m: null });
const tableOf = (...walls: Wall[]) => new Map(walls.map((one, i) => [`w${i}`, one]));

describe('walls', () => {
  test('of every state are told apart without their colour: by width, dashes or crosses', () => {
    const looks = wallStates.map((state) => {
      const painter = new WallsPainter();
      painter.setWalls(tableOf(wall(state)));
      const strokes = painted(painter).of('stroke');
      return JSON.stringify([strokes.length, strokes.map((call) => [call.state['lineWidth'], call.state['dash']])]);
    });
    expect(new Set(looks).size).toBe(wallStates.length);
  });
  test('keep their width on the screen at any zoom', () => {
    const painter = new WallsPainter();
    painter.setWalls(tableOf(wall('confirmed')));
    for (const resolution of [0.01, 0.1, 1]) {
      const [stroke] = painted(painter, { resolution }).of('stroke');
      expect(stroke!.state['lineWidth']).toBeCloseTo(kWallStyles.confirmed.widthPx * resolution, 9);
    }
  });
  test('cost one stroke a state however many there are', () => {
    const painter = new WallsPainter();
    painter.setWalls(tableOf(...Array.from({ length: 500 }, (_, i) => wall(i % 2 ? 'confirmed' : 'new', i))));
    expect(painted(painter).of('stroke')).toHaveLength(2);
  });
  test('that did not change are not prepared again', () => {
    const painter = new WallsPainter();
    const [kept, changed] = [wall('confirmed'), wall('new', 5)];
    const pathsOf = (): unknown[] => painted(painter).of('stroke').map((call) => call.args[0]);
    painter.setWalls(tableOf(kept, changed));
    const before = pathsOf();
    painter.setWalls(tableOf(kept, wall('new', 6)));
    const after = pathsOf();
    expect(after.filter((path) => before.includes(path))).toHaveLength(1);
  });
  test('that somebody hid are not drawn, and what is least certain lies lowest', () => {
    const painter = new WallsPainter();
    painter.setWalls(tableOf(wall('confirmed'), wall('unseen'), wall('new')));
    painter.setVisible(new Set(['new']), 0.5);
    const strokes = painted(painter).of('stroke');
    expect(strokes.map((call) => call.state['strokeStyle'])).toEqual([kLight.walls.unseen, kLight.walls.confirmed]);
    expect(strokes[0]!.state['globalAlpha']).toBe(0.5);
  });
  test('with new colours change at once', () => {
    const painter = new WallsPainter();
    painter.setWalls(tableOf(wall('confirmed')));
    expect(painted(painter, { palette: kDark }).of('stroke')[0]!.state['strokeStyle']).toBe(kDark.walls.confirmed);
  });
});

describe('a plan being prepared', () => {
  test('shows doubtful walls dashed, walls that are off faint, and gaps by their kind', () => {
    const painter = new PlanWallsPainter();
    painter.setWalls(
      [{ a: [0, 0], b: [1, 0], look: 'sure' }, { a: [0, 1], b: [1, 1], look: 'doubtful' }, { a: [0, 2], b: [1, 2], look: 'off' }],
      [{ a: [0, 3], b: [1, 3], kind: 'door' }, { a: [0, 4], b: [1, 4], kind: 'window' }, { a: [0, 5], b: [1, 5], kind: 'passage' }],
    );
    const [sure, doubtful, off, door, window_, passage] = painted(painter).of('stroke').map((call) => call.state);
    expect(sure!['dash']).toEqual([]);
    expect((doubtful!['dash'] as number[]).length).toBe(2);
    expect(off!['globalAlpha']).toBeLessThan(sure!['globalAlpha'] as number);
    expect(new Set([door, window_, passage].map((state) => JSON.stringify([state!['dash'], state!['lineWidth']]))).size).toBe(3);
  });
  test('laid over the map takes one colour, and is not drawn at all when it is faded out', () => {
    const painter = new PlanWallsPainter();
    painter.setWalls([{ a: [0, 0], b: [1, 0], look: 'sure' }]);
    painter.setPlacement([0.02, 0, 0, -0.02, 1, 2], 'plan');
    expect(painted(painter).of('stroke')[0]!.state['strokeStyle']).toBe(kLight.plan);
    expect(painted(painter).of('transform')[0]!.args).toEqual([0.02, 0, 0, -0.02, 1, 2]);
    painter.setOpacity(0);
    expect(painted(painter).calls).toEqual([]);
  });
});

describe('marks', () => {
  const robot = { id: 'r1', x: 1, y: 2, heading: 0.5, sigma_m: 0.05, sigma_rad: 0, localized: true, link: 'fresh', heard_ms: 0, speed: 0, stopped: false, exploring: false, goal: null, path: [], note: '' } as Robot & { id: string };
  const show = (marks: Partial<Parameters<MarksPainter['setMarks']>[0]>) => {
    const painter = new MarksPainter();
    painter.setMarks({ robots: [], pois: [], goals: [], people: [], ...marks });
    return painter;
  };
  test('that are uncertain carry a dashed ring as wide as one standard deviation', () => {
    const canvas = painted(show({ pois: [{ kind: 'fire', label: '', p: [0, 0], sigma: 2, selected: false }] }));
    const ring = canvas.of('arc').find((call) => call.args[2] === 20);
    expect(ring).toBeDefined();
    expect(canvas.of('stroke').some((call) => (call.state['dash'] as number[]).length === 2)).toBe(true);
  });
  test('that are sure, or were placed by hand, carry none', () => {
    for (const sigma of [null, 0, 0.1]) {
      const canvas = painted(show({ pois: [{ kind: 'fire', label: '', p: [0, 0], sigma, selected: false }] }));
      expect(canvas.of('stroke').every((call) => (call.state['dash'] as number[]).length === 0)).toBe(true);
    }
  });
  test('lie where they are on the screen, with their words', () => {
    const canvas = painted(show({ pois: [{ kind: 'exit', label: 'Door', p: [3, 4], sigma: null, selected: false }] }));
    expect(canvas.of('arc')[0]!.args.slice(0, 2)).toEqual([130, 60]);
    expect(canvas.of('fillText').map((call) => call.args[0])).toEqual(['Door']);
  });
  test('a robot points where it looks, also when the view is turned', () => {
    expect(painted(show({ robots: [robot] })).of('rotate')[0]!.args[0]).toBeCloseTo(-0.5, 9);
    expect(painted(show({ robots: [robot] }), { rotation: 1.2 }).of('rotate')[0]!.args[0]).toBeCloseTo(0.7, 9);
  });
  test('a robot that is lost, stopped or not localised looks so', () => {
    const fills = (changes: Partial<Robot>): unknown => painted(show({ robots: [{ ...robot, ...changes }] })).of('fill').at(-1)!.state['fillStyle'];
    expect(fills({})).toBe(kLight.accent);
    expect(fills({ link: 'lost' })).toBe(kLight.muted);
    expect(fills({ stopped: true })).toBe(kLight.danger);
    const unsure = painted(show({ robots: [{ ...robot, localized: false }] }));
    expect(unsure.of('stroke').length).toBe(painted(show({ robots: [robot] })).of('stroke').length + 1);
  });
  test('every kind has a colour, and what is dangerous is not shown as harmless', () => {
    for (const kind of poiKinds) expect(poiColour(kLight, kind)).toMatch(/^#/);
    expect(poiColour(kLight, 'fire')).toBe(kLight.danger);
    expect(poiColour(kLight, 'gas_bottle')).toBe(kLight.warning);
  });
});

describe('sketches', () => {
  test('keep the prepared shape of a stroke until its points change', () => {
    const painter = new StrokesPainter();
    const stroke: ShownStroke = { kind: 'wall', width: 4, points: [[0, 0], [10, 0]] };
    const pathsOf = (): unknown[] => painted(painter).of('fill').map((call) => call.args[0]);
    painter.setStrokes(new Map([['a', stroke]]));
    const [before] = pathsOf();
    painter.setStrokes(new Map([['a', { ...stroke }], ['b', stroke]]));
    expect(pathsOf()[0]).toBe(before);
    painter.setStrokes(new Map([['a', { ...stroke, points: [[0, 0], [20, 0]] }]]));
    expect(pathsOf()[0]).not.toBe(before);
  });
  test('fade under the eraser before they are gone', () => {
    const painter = new StrokesPainter();
    painter.setStrokes(new Map([['a', { kind: 'wall', width: 4, points: [[0, 0]] }], ['b', { kind: 'door', width: 4, points: [[5, 5]] }]]));
    painter.setFaded(new Set(['a']));
    expect(painted(painter).of('fill').map((call) => call.state['globalAlpha'])).toEqual([0.2, 1]);
  });
  test('somebody else\'s ink is drawn until the stroke itself arrives', () => {
    const painter = new LiveInkPainter();
    painter.addOther('a', 'Bo', [[0, 0], [5, 5]]);
    expect(painted(painter).of('fill')).toHaveLength(1);
    painter.dropOthers(['a']);
    expect(painted(painter).of('fill')).toHaveLength(0);
    painter.begin('wall', 4);
    expect(painted(painter).of('fill')).toHaveLength(0);
    painter.add([[1, 1]]);
    expect(painted(painter).of('fill')).toHaveLength(1);
    painter.end();
    expect(painted(painter).of('fill')).toHaveLength(0);
  });
  test('rooms without three corners are no rooms; the chosen one stands out', () => {
    const painter = new RegionsPainter();
    const outline = [[0, 0], [10, 0], [10, 10]] as const;
    painter.setRegions([
      { outline: [[0, 0], [1, 1]], fill: '#fff', label: '0', emphasis: 'none', dashed: false },
      { outline, fill: '#fff', label: '1', emphasis: 'selected', dashed: false },
      { outline, fill: '#fff', label: '2', emphasis: 'faded', dashed: true },
    ]);
    const canvas = painted(painter);
    const [selected, faded] = canvas.of('fill').map((call) => call.state['globalAlpha'] as number);
    expect(selected).toBeGreaterThan(faded!);
    expect(canvas.of('fillText').map((call) => call.args[0])).toEqual(['1', '2']);
  });
  test('the sheet has the size that everybody draws on', () => {
    const painter = new SheetPainter();
    painter.setSize(640, 320);
    expect(painted(painter).of('fillRect')[0]!.args).toEqual([0, -320, 640, 320]);
    const grid = painted(painter).of('stroke')[0]!.args[0] as FakePath;
    expect(grid.calls.filter(([name]) => name === 'moveTo')).toHaveLength(19 + 9);
  });
});

describe('the fit of the plan', () => {
  test('kept, doubtful and rejected links differ in shape', () => {
    const shapes = (['kept', 'doubtful', 'rejected'] as const).map((state) => {
      const painter = new FitPainter();
      painter.setLinks([{ p: [1, 1], corner: 0, state }]);
      const canvas = painted(painter);
      return [canvas.of('arc').length, canvas.of('fill')[0]?.state['fillStyle'] ?? ''].join(' ');
    });
    expect(new Set(shapes).size).toBe(3);
  });
  test('a fixed point shows how far off it is, and the line to where the plan shows it', () => {
    const painter = new FitPainter();
    painter.setAnchors([{ id: 'a', at: [1, 1], shown: [2, 1], residualM: 1, outlier: false }]);
    const canvas = painted(painter);
    expect(canvas.of('lineTo')[0]!.args).toEqual([120, 90]);
    expect(canvas.of('fillText')[0]!.args[0]).toBe('1.0 m');
    painter.setAnchors([{ id: 'a', at: [1, 1], shown: undefined, residualM: undefined, outlier: false }]);
    expect(painted(painter).of('lineTo')).toEqual([]);
    expect(painted(painter).of('fillText')[0]!.args[0]).toBe('?');
  });
  test('parts that are longer and shorter have different colours, as strong as they are off', () => {
    const painter = new FitPainter();
    const corners = [[0, 0], [1, 0], [0, 1]] as const;
    painter.setStretch([{ corners, stretch: 1.1 }, { corners, stretch: 0.95 }, { corners, stretch: 1 }]);
    const states = painted(painter).of('fill').map((call) => call.state);
    expect([states[0]!['fillStyle'], states[1]!['fillStyle']]).toEqual([kLight.accent, kLight.warning]);
    expect(states[0]!['globalAlpha']).toBeGreaterThan(states[1]!['globalAlpha'] as number);
    expect(states[2]!['globalAlpha']).toBe(0);
  });
});

describe('what is painted anew', () => {
  test('every change of what is shown raises the revision', () => {
    const overlay = new OverlayPainter();
    const picture = new PicturePainter();
    const changes: (readonly [{ revision: number }, () => void])[] = [
      [overlay, () => overlay.setShapes([{ kind: 'text', p: [0, 0], text: 'a' }])],
      [picture, () => picture.setPicture(null)],
      [picture, () => picture.setMesh(null)],
      [picture, () => picture.setOpacity(0.5)],
    ];
    for (const [painter, change] of changes) {
      const before = painter.revision;
      change();
      expect(painter.revision).toBeGreaterThan(before);
    }
  });
  test('handles, lines, arrows, crosses and words of an edit are all drawn', () => {
    const painter = new OverlayPainter();
    painter.setShapes([
      { kind: 'line', points: [[0, 0], [1, 1]], tone: 'accent', widthPx: 3, dashed: true, closed: true },
      { kind: 'handle', p: [0, 0], tone: 'ok', radiusPx: 20 },
      { kind: 'cross', p: [0, 0], tone: 'danger' },
      { kind: 'arrow', p: [0, 0], heading: 1, tone: 'danger', lengthPx: 60 },
      { kind: 'text', p: [0, 0], text: '3.4 m' },
    ]);
    const canvas = painted(painter, { rotation: 0.25 });
    expect(canvas.of('closePath')).toHaveLength(1);
    expect(canvas.of('arc').map((call) => call.args[2])).toContain(20);
    expect(canvas.of('rotate')[0]!.args[0]).toBeCloseTo(-0.75, 9);
    expect(canvas.of('fillText')[0]!.args[0]).toBe('3.4 m');
  });
});
