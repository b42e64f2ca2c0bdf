/** Pages as text: what they say, how old it is, and what cannot be pressed and why. Rendered without a browser. */
import type { Component } from 'svelte';
import { render } from 'svelte/server';
import { describe, expect, test, vi } from 'vitest';
import MatchRow from '../src/ui/modes/MatchRow.svelte';
import OperatePanel from '../src/ui/modes/OperatePanel.svelte';
import PoiSheet from '../src/ui/modes/PoiSheet.svelte';
import SketchPanel from '../src/ui/modes/SketchPanel.svelte';
import WallSheet from '../src/ui/modes/WallSheet.svelte';
import Notices from '../src/ui/Notices.svelte';
import { contextOf } from '../src/ui/context';
import { setLanguage } from '../src/ui/i18n.svelte';
import { MapSettings } from '../src/ui/state/map_settings.svelte';
import TopBar from '../src/ui/TopBar.svelte';
import { type Opened, openSession } from './support/open_session';

/** The words of a page, tags left out. */
function words<P extends Record<string, unknown>>(page: Opened, what: Component<P>, props: P): string {
  return html(page, what, props).replace(/<!--.*?-->/gs, '').replace(/<[^>]+>/g, ' ').replace(/\s+/g, ' ');
}
function html<P extends Record<string, unknown>>({ session }: Opened, what: Component<P>, props: P): string {
  return render(what as Component, { props, context: contextOf({ session } as never) }).body;
}
const nothing = (): void => {};

const robot = { x: 1, y: 2, heading: 0, sigma_m: 0.12, sigma_rad: 0, localized: true, link: 'fresh', speed: 0.4, stopped: false, exploring: false, goal: null, path: [], note: '' };
const poi = { kind: 'gas_bottle', label: 'Acetylene', author: 'Bo', frame: 'map', p: [1, 2], map: [1, 2], sigma_m: 0, confidence: 1, reason: '', removed: false };

async function page(role: 'commander' | 'firefighter' | 'observer' = 'commander'): Promise<Opened> {
  const opened = await openSession({ role });
  await opened.welcome();
  const now = opened.around.now;
  await opened.delta('robots', { r1: { ...robot, heard_ms: now - 4_000 } });
  await opened.delta('pois', { p1: { ...poi, created_ms: now - 125_000 } });
  await opened.delta('goals', { g1: { robot: 'r1', author: 'Anna', created_ms: now - 30_000, frame: 'map', p: [5, 5], heading: null, map: [5, 5], sigma_m: 0.1, state: 'driving', reason: '', remaining_m: 9.8, eta_s: 24 } });
  await opened.delta('walls', { w3: { a: [0, 0], b: [1, 0], state: 'moved', confidence: 0.9, moved_m: 0.31 } });
  await opened.around.pass(600);
  return opened;
}
const operate = { settings: new MapSettings(), onselect: nothing, onanchor: nothing, onshow: nothing };

describe('every live value says how old it is', () => {
  test('in Operate: robots, goals and marks', async () => {
    const text = words(await page(), OperatePanel, operate);
    expect(text).toMatch(/heard 4\.[56] s ago/);
    expect(text).toMatch(/r1 · Anna · 3\d s ago/);
    expect(text).toMatch(/Acetylene .* 2 min/);
    expect(text).toContain('9.8 m to go, about 24 s');
  });
  test('in the bar: the link and each robot', async () => {
    const text = words(await page(), TopBar, {});
    expect(text).toMatch(/Live 0\.[56] s/);
    expect(text).toMatch(/r1 good ±0\.12 m 4\.[56] s/);
  });
  test('a robot that is silent stays, with the time since', async () => {
    const opened = await page();
    await opened.delta('robots', { r1: { ...robot, link: 'lost', heard_ms: opened.around.now - 300_000 } }, { rev: 2 });
    expect(words(opened, TopBar, {})).toMatch(/r1 silent 5 min/);
  });
  test('a robot whose place is not known has no quality', async () => {
    const opened = await page();
    await opened.delta('robots', { r1: { ...robot, localized: false, heard_ms: null } }, { rev: 2 });
    expect(words(opened, TopBar, {})).toContain('position unknown');
    expect(words(opened, OperatePanel, operate)).toContain('never heard');
  });
  test('what is seen without a link is said to be old', async () => {
    const opened = await page();
    await opened.lose();
    await opened.around.pass(30_000);
    expect(words(opened, Notices, {})).toMatch(/No link to the server\. What you see is 3\d s old/);
  });
});

describe('what a role may not do', () => {
  const disabled = (text: string): string[] => [...text.matchAll(/<button[^>]*aria-disabled="true"[^>]*title="([^"]*)"/g)].map((match) => match[1]!);
  test('stays in its place and says why', async () => {
    const commander = html(await page('commander'), OperatePanel, operate);
    const firefighter = html(await page('firefighter'), OperatePanel, operate);
    expect(disabled(commander)).toEqual([]);
    expect(disabled(firefighter)).toContain('Only the commander can do this.');
    expect(firefighter.match(/<button/g)!.length).toBe(commander.match(/<button/g)!.length);
  });
  test('an observer reads a mark but cannot remove it', async () => {
    const observer = html(await page('observer'), PoiSheet, { id: 'p1', onclose: nothing });
    expect(disabled(observer)).toEqual(['Observers can look, and stop the robots.']);
    expect(observer).toContain('Acetylene');
  });
});

describe('words on a mark', () => {
  const said = async (changes: object): Promise<string> => {
    const opened = await page();
    await opened.delta('pois', { p1: { ...poi, created_ms: 0, ...changes } }, { rev: 2 });
    return words(opened, PoiSheet, { id: 'p1', onclose: nothing });
  };
  test('never make it more certain than it is', async () => {
    expect(await said({ frame: 'sketch_px', sigma_m: 1.6 })).toContain('somewhere within about ±1.6 m');
    expect(await said({ frame: 'sketch_px', map: null, reason: 'This room has no counterpart.' })).toContain('This room has no counterpart.');
    expect(await said({})).not.toContain('±');
  });
  test('of somebody else are text, whatever they contain', async () => {
    const opened = await page();
    await opened.delta('pois', { p1: { ...poi, created_ms: 0, label: '<img src=x onerror=alert(1)>' } }, { rev: 2 });
    const shown = html(opened, PoiSheet, { id: 'p1', onclose: nothing });
    expect(shown).not.toContain('<img');
    expect(shown).toContain('&lt;img');
  });
  test('are gone when the mark is', async () => {
    const opened = await page();
    expect(words(opened, PoiSheet, { id: 'nobody', onclose: nothing }).trim()).toBe('');
  });
});

describe('walls and rooms in words', () => {
  test('a wall that was moved says by how much', async () => {
    expect(words(await page(), WallSheet, { index: 3, onclose: nothing })).toContain('Seen elsewhere, corrected · moved by 0.31 m');
  });
  test('a pair is sure, likely or doubtful, never a percentage; what a person kept says so', async () => {
    const opened = await page();
    const row = (confidence: number, verdict: 'proposed' | 'confirmed' = 'proposed'): string =>
      words(opened, MatchRow, { row: { id: '1-2', sketch: 1, plan: 2, colour: 0, confidence, verdict }, selected: false, onselect: nothing, onkeep: nothing, onunlink: nothing });
    expect(row(0.9)).toContain('sure');
    expect(row(0.6)).toContain('likely');
    expect(row(0.2)).toContain('doubtful');
    expect(row(0.2, 'confirmed')).toContain('kept by a person');
    expect(row(0.37)).not.toMatch(/37|%/);
  });
  test('rooms of a sketch carry the number and the colour that Match uses', async () => {
    const opened = await page();
    const outline = [[0, 0], [9, 0], [9, 9]];
    await opened.delta('sketch_regions', { 1: { outline, kind: 'room', pair: 4, confidence: 0.9 }, 2: { outline, kind: 'corridor', pair: null, confidence: null } });
    const text = words(opened, SketchPanel, { bounds: () => ({ minX: 0, minY: 0, maxX: 9, maxY: 9 }), gaps: 2, onselect: nothing });
    expect(text).toContain('2 open');
    expect(text).toMatch(/Room 1\s+room 4 of the plan: sure/);
    expect(text).toMatch(/Corridor 2\s+no match yet/);
  });
});

describe('what needs eyes now', () => {
  test('a stop is shown to everybody, and only the commander can release it', async () => {
    for (const role of ['commander', 'observer'] as const) {
      const opened = await page(role);
      await opened.delta('info', { floor: { stopped: true } });
      const shown = html(opened, Notices, {});
      expect(shown).toContain('All robots are stopped.');
      expect(/aria-disabled="true"/.test(shown)).toBe(role === 'observer');
    }
  });
  test('what the server says is said in the language of the page', async () => {
    const opened = await page();
    await opened.delta('alerts', { a: { text: 'This plan does not seem to fit this building.', urgent: true } });
    await opened.delta('goals', { g1: { robot: 'r1', author: 'Anna', created_ms: 0, frame: 'map', p: [5, 5], heading: null, map: [5, 5], sigma_m: 0.1, state: 'failed', reason: 'the robot cannot get on in the smoke: something stands in the way', remaining_m: null, eta_s: null } });
    vi.stubGlobal('document', { documentElement: { lang: 'en' } }).stubGlobal('localStorage', { setItem: nothing });
    await setLanguage('de');
    expect(words(opened, Notices, {})).toContain('Dieser Plan scheint nicht zu diesem Gebäude zu gehören.');
    expect(words(opened, OperatePanel, operate)).toContain('Der Roboter kommt im Rauch nicht weiter: etwas steht im Weg');
    await setLanguage('en');
    vi.unstubAllGlobals();
  });
  test('alerts come with the urgency that the server gave them', async () => {
    const opened = await page();
    await opened.delta('alerts', { a: { text: 'The robot is on fire', urgent: true }, b: { text: 'Battery low', urgent: false } });
    const shown = html(opened, Notices, {});
    expect(shown).toMatch(/role="alert"[^]*on fire/);
    expect(shown).toMatch(/role="status"[^]*Battery low/);
    expect(shown.match(/aria-label="Close"/g)).toHaveLength(1); // what is urgent cannot be put away
  });
});
