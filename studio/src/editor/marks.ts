import {foldService} from '@codemirror/language';
import {StateEffect, StateField, type Extension, type Range} from '@codemirror/state';
import {Decoration, EditorView, type DecorationSet} from '@codemirror/view';
import type {OpenAnswer} from '../contract';

/** What the session knows about the text; sent when it is about the text that stands in the editor. */
export const known = StateEffect.define<OpenAnswer>();

const marks = new Map<string, Decoration>();
const markOf = (kind: string): Decoration => {
  if (!marks.has(kind)) marks.set(kind, Decoration.mark({class: `tok-${kind}`}));
  return marks.get(kind)!;
};

/** Colours of words: they move with an edit until the next answer is there. */
const tokens = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(set, transaction) {
    for (const effect of transaction.effects)
      if (effect.is(known)) {
        const end = transaction.newDoc.length,
          ranges: Range<Decoration>[] = [];
        for (const [from, to, kind] of effect.value.tokens)
          if (kind !== 'other' && from < to && to <= end) ranges.push(markOf(kind).range(from, to));
        return Decoration.set(ranges, true);
      }
    return transaction.docChanged ? set.map(transaction.changes) : set;
  },
  provide: field => EditorView.decorations.from(field),
});

const folds = StateField.define<[number, number][]>({
  create: () => [],
  update(list, transaction) {
    for (const effect of transaction.effects) if (effect.is(known)) return effect.value.folding;
    return transaction.docChanged
      ? list.map(([from, to]) => [transaction.changes.mapPos(from), transaction.changes.mapPos(to)])
      : list;
  },
});

/** A statement folds behind its first line. */
const folding = foldService.of((state, lineStart, lineEnd) => {
  const fold = state.field(folds).find(([from]) => from >= lineStart && from <= lineEnd);
  if (!fold) return null;
  const to = Math.min(fold[1], state.doc.length);
  return to > lineEnd ? {from: lineEnd, to: state.doc.lineAt(to).from === to ? to - 1 : to} : null;
});

export const knownMarks: Extension = [tokens, folds, folding];
