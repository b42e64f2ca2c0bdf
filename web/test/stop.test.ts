import { describe, expect, test } from 'vitest';
import { Stop } from '../src/ui/state/stop.svelte';

/** A clock that is wound by hand, and a link that answers when told. */
function staged() {
  const timers = new Set<{ at: number; run: () => void }>();
  let now = 0;
  let ids = 0;
  const after = (ms: number, run: () => void): (() => void) => {
    const timer = { at: now + ms, run };
    timers.add(timer);
    return () => timers.delete(timer);
  };
  const pass = (ms: number): void => {
    now += ms;
    for (const timer of [...timers].filter(({ at }) => at <= now)) {
      timers.delete(timer);
      timer.run();
    }
  };
  return { stop: new Stop(() => Promise.resolve(`id-${++ids}`), after), pass };
}

describe('the emergency stop', () => {
  test('is confirmed by the answer to its own command, then returns to rest', async () => {
    const { stop, pass } = staged();
    await stop.press();
    stop.answered('somebody else', true);
    expect(stop.state).toBe('sending');
    stop.answered('id-1', true);
    expect(stop.state).toBe('confirmed');
    pass(2_000);
    expect(stop.state).toBe('idle');
  });
  test('says so when half a second passes without an answer, and takes a late answer', async () => {
    const { stop, pass } = staged();
    await stop.press();
    pass(499);
    expect(stop.state).toBe('sending');
    pass(1);
    expect(stop.state).toBe('unconfirmed');
    stop.answered('id-1', true);
    expect(stop.state).toBe('confirmed');
  });
  test('takes an answer that is quicker than the disk', async () => {
    const { stop } = staged();
    const pressed = stop.press();
    stop.answered('id-1', true);
    await pressed;
    expect(stop.state).toBe('confirmed');
  });
  test('that was refused is shown as not confirmed until somebody says that they understood', async () => {
    const { stop, pass } = staged();
    await stop.press();
    stop.answered('id-1', false);
    pass(60_000);
    expect(stop.state).toBe('refused');
    stop.dismiss();
    expect(stop.state).toBe('idle');
  });
});
