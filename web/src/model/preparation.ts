/**
 * A plan being prepared, as a list of steps that can be taken back one by one: corners of the sheet, the walls with their
 * scale, and where the robot stands. Immutable and made of plain data, so it is kept on the disk as it is.
 */
import type { LayoutPx } from '../geometry/points';
import type { PlanDraft } from './plan_draft';

export interface Start {
  readonly p: LayoutPx;
  /** Counter-clockwise from the picture's +x. */
  readonly heading: number;
}

export interface Source {
  readonly planId: string;
  readonly width: number;
  readonly height: number;
}

export interface Edit {
  /** Of the sheet in the picture as taken. */
  readonly corners: readonly LayoutPx[];
  readonly draft: PlanDraft | null;
  readonly start: Start | null;
}

export interface Preparation {
  readonly format: 1;
  readonly source: Source | null;
  readonly edits: readonly Edit[];
  /** Index of the edit that is shown. */
  readonly at: number;
  /** What a person did since the walls were read first: the price of the reader's mistakes. */
  readonly taps: number;
  /** This very state was put in use. */
  readonly sent: boolean;
}

const kDepth = 60;

export const kBlankEdit: Edit = { corners: [], draft: null, start: null };
export const kNothingPrepared: Preparation = { format: 1, source: null, edits: [kBlankEdit], at: 0, taps: 0, sent: false };

export const editOf = ({ edits, at }: Preparation): Edit => edits[at] ?? kBlankEdit;
export const canUndo = ({ at }: Preparation): boolean => at > 0;
export const canRedo = ({ edits, at }: Preparation): boolean => at + 1 < edits.length;

/** Another picture: nothing of the one before it holds. */
export const begun = (source: Source, corners: readonly LayoutPx[]): Preparation => ({
  ...kNothingPrepared,
  source,
  edits: [{ ...kBlankEdit, corners }],
});

/** @param taps how many touches of a person it took; 0 for what the reader did by itself. */
export function edited(state: Preparation, change: Partial<Edit>, taps = 1): Preparation {
  const kept = state.edits.slice(Math.max(0, state.at + 2 - kDepth), state.at + 1);
  const edits = [...kept, { ...editOf(state), ...change }];
  return { ...state, edits, at: edits.length - 1, taps: state.taps + taps, sent: false };
}

/** The first reading is where a person starts from: there is nothing before it to go back to. */
export const asRead = (state: Preparation, change: Partial<Edit>): Preparation =>
  editOf(state).draft === null ? { ...state, edits: [{ ...editOf(state), ...change }], at: 0, sent: false } : edited(state, change);

const moved = (state: Preparation, by: -1 | 1): Preparation =>
  state.edits[state.at + by] ? { ...state, at: state.at + by, taps: state.taps + 1, sent: false } : state;

export const undone = (state: Preparation): Preparation => moved(state, -1);
export const redone = (state: Preparation): Preparation => moved(state, 1);

/** What the disk gave back; nothing prepared for what another version of the page left there. */
export function restorePreparation(value: unknown): Preparation {
  const state = value as Partial<Preparation> | null | undefined;
  if (state?.format !== 1 || !Array.isArray(state.edits) || !Number.isSafeInteger(state.at)) return kNothingPrepared;
  const isSound = state.edits.every((edit: Partial<Edit>) => Array.isArray(edit.corners) && (edit.draft === null || Array.isArray(edit.draft?.openings)));
  return isSound && state.edits[state.at!] ? { ...kNothingPrepared, ...state } : kNothingPrepared;
}
