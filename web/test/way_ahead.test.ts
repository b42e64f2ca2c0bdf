import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { mapPoint } from '../src/geometry/points';
import { Api } from '../src/link/api';
import { WayAhead } from '../src/ui/state/way_ahead.svelte';

/** A server whose answers come when the test lets them. */
function held() {
  const asked: { url: string; answer: (body: unknown, status?: number) => Promise<void> }[] = [];
  const api = new Api(
    (input) =>
      new Promise((resolve) => {
        const answer = async (body: unknown, status = 200): Promise<void> => {
          resolve(new Response(JSON.stringify(body), { status }));
          await vi.advanceTimersByTimeAsync(0);
        };
        asked.push({ url: String(input), answer });
      }),
  );
  return { ahead: new WayAhead(api), asked };
}
const east = { path: [[0, 0], [4, 0]], length_m: 4, unseen_m: 1, reason: '' };

describe('the way that is shown before a robot is sent', () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  test('is asked for at once and again while somebody looks at it', async () => {
    const { ahead, asked } = held();
    const stop = ahead.follow('robot 1', mapPoint(4, -0.125));
    expect(asked[0]!.url).toBe('/api/way?robot=robot+1&x=4.00&y=-0.13');
    expect(ahead.way).toBeUndefined();
    await asked[0]!.answer(east);
    expect(ahead.way).toEqual(east);
    await vi.advanceTimersByTimeAsync(2_000);
    await asked[1]!.answer({ path: [], reason: 'no way there is known' });
    expect(ahead.way).toEqual({ path: [], length_m: 0, unseen_m: 0, reason: 'no way there is known' });
    stop();
    expect(ahead.way).toBeUndefined();
    await vi.advanceTimersByTimeAsync(10_000);
    expect(asked).toHaveLength(2);
  });

  test('is never the way to a place that was meant before', async () => {
    const { ahead, asked } = held();
    ahead.follow('robot1', mapPoint(4, 0))();
    ahead.follow('robot1', mapPoint(9, 9));
    await asked[0]!.answer(east);
    expect(ahead.way).toBeUndefined();
    await asked[1]!.answer({ ...east, length_m: 13 });
    expect(ahead.way?.length_m).toBe(13);
  });

  test('is not shown when the server does not answer, or says something else', async () => {
    const { ahead, asked } = held();
    ahead.follow('robot1', mapPoint(4, 0));
    await asked[0]!.answer(east);
    for (const [body, status] of [[{ error: { code: 'not_found', message: 'there is no robot robot1' } }, 404], [{ path: 'east' }, 200]] as const) {
      await vi.advanceTimersByTimeAsync(2_000);
      await asked.at(-1)!.answer(body, status);
      expect(ahead.way).toBeUndefined();
    }
  });
});
