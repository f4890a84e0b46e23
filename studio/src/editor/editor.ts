import {
  acceptCompletion,
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  completionStatus,
  moveCompletionSelection,
  selectedCompletionIndex,
  snippetCompletion,
  type Completion,
  type CompletionContext,
  type CompletionResult,
} from '@codemirror/autocomplete';
import {
  defaultKeymap,
  history,
  historyKeymap,
  indentWithTab,
  redo,
  redoDepth,
  undo,
  undoDepth,
} from '@codemirror/commands';
import {bracketMatching, codeFolding, foldGutter, foldKeymap} from '@codemirror/language';
import {lintGutter, lintKeymap, setDiagnostics, type Diagnostic as Lint} from '@codemirror/lint';
import {highlightSelectionMatches, openSearchPanel, search, searchKeymap} from '@codemirror/search';
import {Annotation, EditorState, Text, Transaction} from '@codemirror/state';
import {
  drawSelection,
  EditorView,
  highlightActiveLine,
  highlightSpecialChars,
  hoverTooltip,
  keymap,
  lineNumbers,
  type Tooltip,
  type ViewUpdate,
} from '@codemirror/view';
import type {CompletionItem, Diagnostic, Edit, Fix, OpenAnswer} from '../contract';
import {byId, h, prose} from '../dom';
import type {Store} from '../store';
import type {State} from '../state';
import {longest, type Study} from '../study';
import {ask as askFor} from '../tools/dialog';
import {known, knownMarks} from './marks';
import {markdown} from './markdown';

const fromOutside = Annotation.define<boolean>();
const symbols: Record<string, string> = {
  statement: 'keyword',
  word: 'keyword',
  name: 'variable',
  function: 'function',
  unit: 'constant',
  member: 'property',
  snippet: 'text',
};

/** The text of the model, with everything that the session says about it. */
export class Editor {
  readonly view: EditorView;
  private fixes: Fix[] = [];
  private fixesOf = Text.empty; // the text that `fixes` mend
  private loaded = 0;
  private signatureTimer = 0;

  constructor(
    private readonly store: Store<State>,
    private readonly study: Study,
    private readonly onMessages: (messages: Diagnostic[], fixes: Fix[]) => void,
  ) {
    this.view = new EditorView({parent: byId('editor'), state: this.fresh('')});
    store.watch(['text', 'loads'], state => this.take(state));
    store.watch(['openedText', 'opened', 'deep'], () => this.mark());
  }

  private fresh(text: string): EditorState {
    return EditorState.create({doc: text, extensions: this.extensions()});
  }

  /** A text that was not typed here. Another model begins another history: undo never leads into the one before. */
  private take({text, loads}: State): void {
    if (loads !== this.loaded) {
      this.loaded = loads;
      this.view.setState(this.fresh(text));
      return this.depths(this.view.state);
    }
    if (text === this.view.state.doc.toString()) return;
    this.view.dispatch({
      changes: {from: 0, to: this.view.state.doc.length, insert: text},
      annotations: fromOutside.of(true),
    });
  }

  /** Changes that the page makes stand in the history, so that undo takes them back. */
  apply(edits: Edit[], focus = true): void {
    if (edits.length === 0) return;
    this.view.dispatch({changes: edits, annotations: Transaction.userEvent.of('input.edit')});
    if (focus) this.view.focus();
  }

  /** A fix mends the text that it was made for. */
  mend(fix: Fix): void {
    if (this.view.state.doc !== this.fixesOf) return this.study.say('The text changed meanwhile; look again.');
    this.apply(fix.edits);
  }

  goTo(from: number, to = from): void {
    const end = this.view.state.doc.length;
    this.view.dispatch({selection: {anchor: Math.min(from, end), head: Math.min(to, end)}, scrollIntoView: true});
    this.view.focus();
  }

  find(): void {
    openSearchPanel(this.view);
  }

  undo(): void {
    undo(this.view);
  }

  redo(): void {
    redo(this.view);
  }

  /** A sign that a keyboard of glass hides or lacks, as if it had been typed. */
  type(sign: string): void {
    this.view.dispatch(this.view.state.replaceSelection(sign), {userEvent: 'input.type', scrollIntoView: true});
    this.view.focus();
  }

  /** What can be taken back, and what can be done again. */
  private depths(state: EditorState): void {
    byId<HTMLButtonElement>('undo-button').disabled = undoDepth(state) === 0;
    byId<HTMLButtonElement>('redo-button').disabled = redoDepth(state) === 0;
  }

  private extensions() {
    return [
      EditorView.updateListener.of(update => this.depths(update.state)),
      lineNumbers(),
      foldGutter(),
      codeFolding(),
      lintGutter(),
      history(),
      drawSelection(),
      highlightSpecialChars(),
      highlightActiveLine(),
      bracketMatching(),
      closeBrackets(),
      highlightSelectionMatches(),
      search({top: true}),
      EditorState.tabSize.of(4),
      EditorView.lineWrapping,
      // What is offered is not chosen yet: Enter is a new line until an arrow key, or a click, chooses an entry.
      autocompletion({
        override: [context => this.complete(context)],
        activateOnTypingDelay: 60,
        icons: false,
        selectOnOpen: false,
      }),
      hoverTooltip((_, at) => this.hover(at), {hoverTime: 350}),
      keymap.of([
        {
          key: 'F2',
          run: () => {
            void this.rename();
            return true;
          },
        },
        {
          key: 'F12',
          run: () => {
            void this.define(this.head);
            return true;
          },
        },
        {
          key: 'Shift-F12',
          run: () => {
            void this.uses();
            return true;
          },
        },
        {
          key: 'Shift-Alt-f',
          run: () => {
            void this.format();
            return true;
          },
        },
        {key: 'Mod-.', run: () => this.fixHere()},
        {key: 'Tab', run: acceptFirst},
        ...closeBracketsKeymap,
        ...defaultKeymap,
        ...searchKeymap,
        ...historyKeymap,
        ...foldKeymap,
        ...lintKeymap,
        indentWithTab,
      ]),
      EditorView.contentAttributes.of({
        'aria-label': 'Model text',
        tabindex: '0',
        spellcheck: 'false',
        autocorrect: 'off',
        autocapitalize: 'off',
      }),
      EditorView.domEventHandlers({
        click: event => {
          if (!(event.ctrlKey || event.metaKey)) return false;
          const at = this.view.posAtCoords({x: event.clientX, y: event.clientY});
          if (at === null) return false;
          void this.define(at);
          return true;
        },
      }),
      knownMarks,
      EditorView.updateListener.of(update => this.changed(update)),
    ];
  }

  private get head(): number {
    return this.view.state.selection.main.head;
  }

  private changed(update: ViewUpdate): void {
    if (update.docChanged && !update.transactions.some(t => t.annotation(fromOutside)))
      this.study.edit(update.state.doc.toString());
    if (update.docChanged || update.selectionSet) {
      window.clearTimeout(this.signatureTimer);
      this.signatureTimer = window.setTimeout(() => void this.signature(), 150);
    }
  }

  // ----------------------------------------------------------------------------------------------------- diagnostics

  private async mark(): Promise<void> {
    const {opened, openedText, deep, text} = this.store.state;
    if (opened && text.length > longest) return this.unmark(opened);
    if (!opened || openedText !== this.view.state.doc.toString()) return;
    const messages = all(opened.diagnostics, deep);
    this.fixes = [];
    this.view.dispatch({effects: known.of(opened)});
    this.show(messages);
    if (messages.length === 0) return;
    const answer = await this.study.asker.ask<{fixes: Fix[]}>({do: 'fixes', from: 0, to: openedText.length, budget: 3});
    if (!answer.ok || this.view.state.doc.toString() !== openedText || answer.fixes.length === 0) return;
    this.fixes = answer.fixes;
    this.fixesOf = this.view.state.doc;
    this.show(messages);
  }

  /** A text that is not read has no colours, and none of the marks of the one before. */
  private unmark(opened: OpenAnswer): void {
    this.fixes = [];
    this.view.dispatch({effects: known.of({...opened, tokens: [], folding: []})});
    this.show([]);
  }

  private show(messages: Diagnostic[]): void {
    const end = this.view.state.doc.length;
    const lint: Lint[] = messages
      .filter(m => m.from !== null && m.to !== null)
      .map(m => ({
        from: Math.min(m.from!, end),
        to: Math.min(Math.max(m.to!, m.from!), end),
        severity: m.severity === 'note' ? 'info' : m.severity,
        message: m.message,
        renderMessage: () =>
          h(
            'div',
            {class: 'lint'},
            h('p', {class: 'what'}, ...prose(m.message)),
            m.reason && h('p', {}, ...prose(m.reason)),
            m.help && h('p', {class: 'help'}, ...prose(m.help)),
          ),
        actions: fixesFor(m, this.fixes).map(fix => ({name: fix.title, apply: () => this.mend(fix)})),
      }));
    this.view.dispatch(setDiagnostics(this.view.state, lint));
    this.onMessages(messages, this.fixes);
  }

  private fixHere(): boolean {
    const at = this.head,
      fix =
        this.fixes.find(one => one.from <= at && at <= one.to) ??
        this.fixes.find(one => this.view.state.doc.lineAt(one.from).number === this.view.state.doc.lineAt(at).number);
    if (!fix) this.study.say('There is nothing here that is mended with one key.');
    else this.mend(fix);
    return true;
  }

  // ------------------------------------------------------------------------------------------------------ at a place

  private async complete(context: CompletionContext): Promise<CompletionResult | null> {
    const before = context.matchBefore(/[\p{L}\p{N}_']+/u);
    if (!context.explicit && !before) return null;
    const answer = await this.study.asker.ask<{from: number; to: number; items: CompletionItem[]}>({
      do: 'complete',
      at: context.pos,
      budget: 3,
    });
    // No result, in the place of an empty one, would end what was typed meanwhile without another question.
    if (!answer.ok) return {from: context.pos, options: []};
    const typed = context.state.sliceDoc(answer.from, context.pos).toLowerCase();
    const items = answer.items.filter(item => matches(item, typed)).sort((a, b) => a.rank - b.rank);
    return {from: answer.from, options: items.map((item, i) => option(item, items.length - i)), filter: false};
  }

  private async hover(at: number): Promise<Tooltip | null> {
    const answer = await this.study.asker.ask<{from: number | null; to: number | null; markdown: string}>({
      do: 'hover',
      at,
      budget: 3,
    });
    if (!answer.ok || answer.from === null || !answer.markdown) return null;
    return {
      pos: answer.from,
      end: answer.to ?? undefined,
      above: true,
      create: () => ({dom: markdown(answer.markdown)}),
    };
  }

  private async signature(): Promise<void> {
    const line = byId('signature'),
      {text, from} = this.view.state.doc.lineAt(this.head);
    if (!text.slice(0, this.head - from).includes('(')) return line.replaceChildren();
    const answer = await this.study.asker.ask<{label: string; parameters: string[]; active: number; help: string}>({
      do: 'signature',
      at: this.head,
      budget: 3,
    });
    if (!answer.ok || !answer.label) return line.replaceChildren();
    const open = answer.label.indexOf('('),
      name = open < 0 ? answer.label : answer.label.slice(0, open);
    const parameters = answer.parameters.flatMap((one, i) => [
      i ? ', ' : '',
      i === answer.active ? h('b', {}, one) : one,
    ]);
    line.replaceChildren(h('code', {}, name, '(', ...parameters, ')'), ` ${answer.help}`);
  }

  async define(at: number): Promise<void> {
    const answer = await this.study.asker.ask<{from: number | null; to: number | null}>({do: 'definition', at});
    if (answer.ok && answer.from !== null) this.goTo(answer.from, answer.to ?? answer.from);
    else this.study.say('Nothing is declared under this name here.');
  }

  private async uses(): Promise<void> {
    const answer = await this.study.asker.ask<{places: [number, number][]}>({do: 'references', at: this.head});
    if (!answer.ok || answer.places.length === 0) return this.study.say('There is no name here.');
    const next = answer.places.find(([from]) => from > this.head) ?? answer.places[0];
    this.goTo(next[0], next[1]);
    this.study.say(
      `${answer.places.length} places; this is the one in line ${this.view.state.doc.lineAt(next[0]).number}.`,
    );
  }

  async rename(): Promise<void> {
    const word = this.view.state.wordAt(this.head),
      old = word ? this.view.state.sliceDoc(word.from, word.to) : '';
    const at = this.head,
      name = await askFor('Another name', `Instead of ${old || 'this name'}:`, old, 'Rename');
    if (!name || name === old) return this.view.focus();
    const {doc} = this.view.state,
      answer = await this.study.asker.ask<{edits: Edit[]; refusal: string}>({do: 'rename', at, name});
    if (!answer.ok) return this.study.say(answer.trouble.message, true);
    if (answer.refusal) return this.study.say(answer.refusal, true);
    if (this.view.state.doc === doc) this.apply(answer.edits);
  }

  async format(): Promise<void> {
    const {doc} = this.view.state,
      answer = await this.study.asker.ask<{edits: Edit[]; refusal?: string}>({do: 'format'});
    if (!answer.ok) return this.study.say(answer.trouble.message, true);
    if (this.view.state.doc !== doc) return;
    if (answer.refusal)
      return this.study.say(`A text with a mistake of grammar is not laid out: ${answer.refusal}.`, true);
    if (answer.edits.length === 0) this.study.say('The text is in its layout.');
    this.apply(answer.edits);
  }
}

/** Tab takes the entry that is chosen, or the first. */
function acceptFirst(view: EditorView): boolean {
  if (completionStatus(view.state) !== 'active') return false;
  if (selectedCompletionIndex(view.state) === null) moveCompletionSelection(true)(view);
  return acceptCompletion(view);
}

const fixesFor = (m: Diagnostic, fixes: Fix[]): Fix[] =>
  fixes.filter(fix => fix.code === m.code && fix.from === m.from);

/** What the text says and what only a derivation finds, each once. */
function all(text: Diagnostic[], deep: Diagnostic[]): Diagnostic[] {
  const seen = new Set<string>();
  return [...text, ...deep].filter(m => {
    const key = `${m.code} ${m.from} ${m.message}`;
    return seen.has(key) ? false : (seen.add(key), true);
  });
}

const spelled: Record<string, string> = {
  α: 'alpha',
  β: 'beta',
  γ: 'gamma',
  δ: 'delta',
  ε: 'epsilon',
  ζ: 'zeta',
  η: 'eta',
  θ: 'theta',
  ι: 'iota',
  κ: 'kappa',
  λ: 'lambda',
  μ: 'mu',
  ν: 'nu',
  ξ: 'xi',
  π: 'pi',
  ρ: 'rho',
  σ: 'sigma',
  τ: 'tau',
  υ: 'upsilon',
  φ: 'phi',
  χ: 'chi',
  ψ: 'psi',
  ω: 'omega',
  Γ: 'Gamma',
  Δ: 'Delta',
  Θ: 'Theta',
  Λ: 'Lambda',
  Ξ: 'Xi',
  Π: 'Pi',
  Σ: 'Sigma',
  Φ: 'Phi',
  Ψ: 'Psi',
  Ω: 'Omega',
};
function matches(item: CompletionItem, typed: string): boolean {
  if (!typed) return true;
  const label = item.label.toLowerCase(),
    latin = [...item.label]
      .map(c => spelled[c] ?? c)
      .join('')
      .toLowerCase();
  return label.startsWith(typed) || latin.startsWith(typed) || item.insert.toLowerCase().startsWith(typed);
}

function option(item: CompletionItem, boost: number): Completion {
  const shown: Completion = {
    label: item.label,
    detail: item.detail,
    type: symbols[item.kind] ?? 'text',
    boost: Math.min(99, boost),
    info: item.help ? () => h('div', {class: 'markdown'}, h('p', {}, ...prose(item.help))) : undefined,
  };
  return item.snippet
    ? snippetCompletion(item.insert.replace(/\$\{(\d+)\|([^,|}]*)[^}]*\}/g, '${$1:$2}').replace(/\$0/g, '${}'), shown)
    : {...shown, apply: item.insert || item.label};
}
