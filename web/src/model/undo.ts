/** What one person can take back on this device: own acts only, never those of others. Immutable. */
export interface Act<C> {
  readonly forward: readonly C[];
  readonly backward: readonly C[];
}

export interface History<C> {
  readonly done: readonly Act<C>[];
  readonly undone: readonly Act<C>[];
}

const kDepth = 200;

export const emptyHistory = <C>(): History<C> => ({ done: [], undone: [] });

export const record = <C>(history: History<C>, act: Act<C>): History<C> => ({
  done: [...history.done, act].slice(-kDepth),
  undone: [],
});

/** The commands to carry out, and what the history is then; undefined when there is nothing to take back. */
export function undo<C>(history: History<C>): { commands: readonly C[]; history: History<C> } | undefined {
  const act = history.done.at(-1);
  if (!act) return undefined;
  return {
    commands: act.backward,
    history: { done: history.done.slice(0, -1), undone: [...history.undone, act] },
  };
}

export function redo<C>(history: History<C>): { commands: readonly C[]; history: History<C> } | undefined {
  const act = history.undone.at(-1);
  if (!act) return undefined;
  return {
    commands: act.forward,
    history: { done: [...history.done, act], undone: history.undone.slice(0, -1) },
  };
}
