import type {Asker} from './asker';
import type {Clock} from './clock';
import type {Answer, ClaimAnswer, Conserved, EquationsAnswer, Failure, OpenAnswer, RunAnswer, Values} from './contract';
import {Drags} from './drags';
import type {Ends} from './lines';
import {short, unfinished} from './runs';
import {Searches} from './searches';
import {heldIntegral, inTime, noDuration, type State} from './state';
import type {Store} from './store';

export const longest = 1_000_000; // characters of a model: as much as a session takes
const restAfter = 220, // ms without a move of a slider
  lateAfter = 500, // ms that an older answer may stand in the place of the one that is asked for
  quick = {frames: 160, budget: 1, brief: true},
  full = {frames: 1500, budget: 20, brief: false};

/** `saved`: the text of its file, or as it was before it was changed; without it, `text`. */
export interface Model {
  text: string;
  ends?: Ends;
  saved?: string;
  name: string;
  set?: Record<string, string>;
  start?: Record<string, string>;
  origin?: State['origin'];
}

/** What follows from the text and the values: asks for it when they change, and puts the answers into the state. */
export class Study {
  // Changes of what is asked for: of the text or the mode, and of these or any value. Answers to what was asked before
  // are let go.
  private texts = 0;
  changes = 0;
  private equationsOf = 0; // of `texts`: what the equations that are shown were asked for
  private runOf = 0; // of `changes`
  private troubleOf = 0; // of `changes`: what the trouble of the run was asked for
  private resting = 0; // a timer, while a slider moves
  private late = 0; // a timer, while something that is shown is of former values
  private shown = false; // something of this model was shown: the clock goes on where it is
  readonly drags: Drags;
  readonly searches: Searches;

  constructor(
    readonly store: Store<State>,
    readonly asker: Asker,
    private readonly clock: Clock,
  ) {
    this.drags = new Drags(this, clock);
    this.searches = new Searches(this);
    asker.onBusy(kind => store.update({busy: kind, progress: null}));
    store.watch(['busy', 'answered', 'readable', 'text', 'openedText'], state => {
      const {busy, answered, readable, text, openedText} = state;
      document.body.dataset.settled = String(busy === null && text === openedText && (answered || !readable));
    });
  }

  get values(): Values {
    const {set, start, duration, mode, forces} = this.store.state;
    return {
      set,
      start,
      ...(forces === 'asked' ? {} : {forces: forces === 'all'}),
      ...(duration ? {run: duration} : {}),
      ...(mode ? {mode} : {}),
    };
  }

  say(text: string, trouble = false): void {
    this.store.update({word: {text, trouble}});
  }

  // ---------------------------------------------------------------------------------------------------- what is asked

  private change(patch: Partial<State>, {ofText}: {ofText: boolean}): void {
    ++this.changes;
    if (ofText) ++this.texts;
    window.clearTimeout(this.resting);
    this.resting = 0;
    this.asker.outdate();
    this.store.update({...patch, answered: false});
    this.watch();
  }

  /** What is shown of a former text or former values is called so where its successor takes long. */
  private watch(): void {
    if (this.late || (this.runOf === this.changes && this.equationsOf === this.texts)) return;
    this.late = window.setTimeout(() => {
      this.late = 0;
      const {run, equations} = this.store.state;
      this.store.update({
        runLate: run !== null && this.runOf !== this.changes,
        equationsLate: equations !== null && this.equationsOf !== this.texts,
        ...(this.troubleOf === this.changes ? {} : {runTrouble: null}),
      });
    }, lateAfter);
  }

  private arrived(): void {
    window.clearTimeout(this.late);
    this.late = 0;
    this.watch();
  }

  private nothingFound(): Partial<State> {
    const {section, sectionGone, busy} = this.store.state;
    return {
      modes: null,
      phaseSpace: null,
      paths: null,
      found: null,
      section: null,
      sectionTrouble: null,
      sectionGone: sectionGone || section !== null || busy === 'section',
    };
  }

  // ------------------------------------------------------------------------------------------------------- the text

  /** Another model: nothing of the one before stays. */
  load({text, ends = '\n', saved = text, name, set = {}, start = {}, origin = null}: Model): void {
    this.shown = false;
    this.drags.letGo();
    this.clock.play(false);
    this.clock.seek(0);
    const patch: Partial<State> = {
      text,
      ends,
      saved,
      loads: this.store.state.loads + 1,
      name,
      origin,
      set,
      start,
      duration: '',
      mode: '',
      equations: null,
      run: null,
      equationsTrouble: null,
      runTrouble: null,
      runLate: false,
      equationsLate: false,
      slow: false,
      quick: false,
      pose: null,
      charts: null,
      pins: [],
      deep: [],
      ...this.nothingFound(),
      sectionGone: false,
    };
    this.change(patch, {ofText: true});
    void this.readText();
  }

  edit(text: string): void {
    if (text === this.store.state.text) return;
    this.change({text}, {ofText: true});
    void this.readText();
  }

  private async readText(): Promise<void> {
    const {text, name} = this.store.state;
    if (text.length > longest)
      return this.store.update({
        readable: false,
        openedText: text,
        deep: [],
        equationsTrouble: {
          code: '',
          message: 'The text is too long.',
          reason: `A person writes a model; this has ${(text.length / 1e6).toFixed(1)} million characters.`,
          help: 'Is it the right file? Undo brings the text before it back.',
        },
      });
    const opened = await this.asker.ask<OpenAnswer>({do: 'open', text, name: `${name}.lag`});
    if (!opened.ok) {
      if (opened.kind !== 'cancelled')
        this.store.update({
          equationsTrouble: opened.trouble,
          readable: false,
          equationsLate: this.store.state.equations !== null,
          runLate: this.store.state.run !== null,
        });
      return;
    }
    if (text !== this.store.state.text) return;
    this.store.update({
      opened,
      openedText: text,
      ...(opened.readable ? {} : {equationsTrouble: null}),
      readable: opened.readable,
      ...(opened.readable ? {} : {deep: []}),
    });
    if (opened.readable) await this.follow();
  }

  /** Equations and motion of the text that is open. */
  private async follow(): Promise<void> {
    const {changes} = this;
    this.store.update(this.nothingFound());
    await this.askEquations();
    if (changes === this.changes) await this.askRun(full);
    if (changes === this.changes) await this.askCertainty();
  }

  async askEquations(): Promise<void> {
    const {steps, equations} = this.store.state,
      {texts, changes} = this;
    const answer = await this.asker.ask<EquationsAnswer>({do: 'equations', steps, ...this.values});
    if (texts !== this.texts) return;
    if (answer.ok) {
      this.equationsOf = texts;
      this.store.update({
        equations: answer,
        equationsText: this.store.state.text,
        equationsTrouble: null,
        equationsLate: false,
        deep: answer.diagnostics,
      });
      if (!this.shown) document.title = `${answer.title || answer.name} – Maupertuis`;
      this.arrived();
    } else if (answer.kind !== 'cancelled' && changes === this.changes) {
      if (this.dropForeignValues(answer)) return;
      this.store.update({
        equationsTrouble: answer.trouble,
        equationsLate: equations !== null,
        deep: answer.diagnostics ?? [],
      });
    }
  }

  /** Values of names that the text has no more are let go, with a word, and everything is asked without them. */
  private dropForeignValues(failure: Failure): boolean {
    const {set, start, text} = this.store.state;
    if (!failure.diagnostics?.some(d => d.severity === 'error' && d.text)) return false;
    const known = (name: string) => text.includes(name.replace(/'+$/, ''));
    const kept = (values: Record<string, string>) =>
      Object.fromEntries(Object.entries(values).filter(([name]) => known(name)));
    const next = {set: kept(set), start: kept(start)};
    const before = Object.keys(set).length + Object.keys(start).length,
      after = Object.keys(next.set).length + Object.keys(next.start).length;
    if (before === after) return false;
    this.say('Values of names that the text does not have any more were dropped.');
    this.change(next, {ofText: false});
    void this.follow();
    return true;
  }

  async wantSteps(): Promise<void> {
    if (this.store.state.steps && this.store.state.equations?.derivation) return;
    this.store.update({steps: true});
    if (this.store.state.readable) await this.askEquations();
  }

  // ------------------------------------------------------------------------------------------------------- the motion

  private async askRun(how: typeof full): Promise<void> {
    const {changes, texts} = this,
      outdated = (): boolean =>
        how === quick ? texts !== this.texts || this.resting === 0 : changes !== this.changes;
    if (!this.store.state.opened?.readable) return;
    const answer = await this.asker.ask<RunAnswer>(
      {do: 'run', ...how, ...this.values},
      {
        quick: how === quick,
        onMessage: message => {
          if (how === full && message.progress !== undefined && !outdated())
            this.store.update({progress: message.progress});
        },
      },
    );
    if (outdated() || (!answer.ok && answer.kind === 'cancelled')) return;
    if (how === quick && (answer.ok ? unfinished(answer) : answer.kind === 'budget'))
      return this.store.update({slow: true, runLate: this.store.state.run !== null});
    if (answer.ok) this.showRun(answer, how, changes);
    else this.showRunTrouble(answer, how);
  }

  private showRun(run: RunAnswer, how: typeof full, of: number): void {
    if (run.drawing)
      for (const element of run.drawing.elements) element.positions = element.positions.map(value => value ?? NaN);
    if (/^dimensionless\b/m.test(this.store.state.text)) run.independent.unit = '';
    if (how.brief) run.conserved = this.withFormulas(run.conserved);
    const first = !this.shown;
    this.shown = true;
    this.runOf = of;
    this.clock.take(run, first);
    this.store.update({
      run,
      runText: this.store.state.text,
      runTrouble: null,
      runLate: false,
      slow: false,
      quick: how === quick,
      answered: how === full,
      pose: this.drags.holding ? this.store.state.pose : null,
    });
    this.arrived();
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (first && !still) this.clock.play(true);
  }

  /** Formulas stay while values move: a brief run has none. */
  private withFormulas(brief: Conserved[]): Conserved[] {
    const {run, equations} = this.store.state,
      known = new Map([...(equations?.conserved ?? []), ...(run?.conserved ?? [])].map(c => [c.sentence, c.formula]));
    return brief.flatMap(c => (known.has(c.sentence) ? [{...c, formula: known.get(c.sentence)!}] : []));
  }

  private showRunTrouble(failure: Failure, how: typeof full): void {
    if (this.dropForeignValues(failure)) return;
    this.troubleOf = this.changes;
    const {trouble, diagnostics} = failure,
      noMotion = trouble.code === noDuration || trouble.code === heldIntegral,
      run = noMotion ? null : this.store.state.run;
    this.store.update({
      run,
      runTrouble: trouble,
      runLate: run !== null,
      slow: false,
      quick: false,
      answered: how === full,
      ...(diagnostics?.length && !noMotion ? {deep: diagnostics} : {}),
    });
  }

  /** Values change: a quick run now, everything when they rest. */
  private changeValues(patch: Partial<State>, resting: boolean): void {
    this.change({...patch, ...this.nothingFound()}, {ofText: false});
    if (resting) return void this.everything();
    void this.askRun(quick);
    this.resting = window.setTimeout(() => {
      this.resting = 0;
      void this.everything();
    }, restAfter);
  }

  /** The motion begins here, as a drag left it; false where something was changed before it came. */
  async beginAt(start: Record<string, string>): Promise<boolean> {
    this.change({start, ...this.nothingFound()}, {ofText: false});
    const {changes} = this;
    await this.everything();
    return changes === this.changes;
  }

  private async everything(): Promise<void> {
    const {changes} = this;
    await this.askRun(full);
    if (changes === this.changes) await this.askEquations();
    if (changes === this.changes) await this.askCertainty();
  }

  /** Until when digits of the motion are certain: a second run beside it finds that, and is not waited for. */
  private async askCertainty(): Promise<void> {
    const {changes} = this,
      {run} = this.store.state;
    if (!run || this.runOf !== changes || run.fields || unfinished(run)) return;
    const answer = await this.asker.ask<RunAnswer>({do: 'run', frames: 2, budget: 20, errors: true, ...this.values});
    const {run: shown} = this.store.state;
    if (changes === this.changes && shown && answer.ok && !unfinished(answer) && answer.uncertain)
      this.store.update({run: {...shown, uncertain: answer.uncertain}});
  }

  setValue(name: string, value: string | null, resting: boolean): void {
    this.changeValues({set: withValue(this.store.state.set, name, value)}, resting);
  }

  setStart(name: string, value: string | null, resting: boolean): void {
    if (resting) this.clock.seek(0);
    this.changeValues({start: withValue(this.store.state.start, name, value)}, resting);
  }

  /** A number alone is in the unit of the variable that the motion runs in, as in the options of the program. */
  setDuration(text: string): void {
    const {run, equations} = this.store.state,
      unit = run?.independent.unit ?? (equations && inTime(this.store.state) ? 's' : ''),
      bare = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text);
    this.changeValues({duration: bare && unit ? `${text} ${unit}` : text}, true);
  }

  /** Arrows of all forces come with a run: it is asked for again where they are not in it. */
  showForces(forces: State['forces']): void {
    if (forces !== 'all' || this.store.state.forces === 'all') return this.store.update({forces});
    this.change({forces}, {ofText: false});
    void this.everything();
  }

  setMode(mode: string): void {
    this.change({mode}, {ofText: true});
    void this.follow();
  }

  resetValues(): void {
    if (this.store.state.mode) this.change({mode: ''}, {ofText: true});
    this.changeValues({set: {}, start: {}, duration: ''}, true);
  }

  pin(): void {
    const {run, pins, set, start} = this.store.state;
    if (!run) return;
    if (this.runOf !== this.changes) return this.say('The run of these values is not there yet.', true);
    if (pins.length >= 5) return this.say('Five runs are pinned; take one away first.', true);
    const said = [...Object.entries(set), ...Object.entries(start)]
      .slice(0, 3)
      .map(([name, value]) => `${name} = ${short(value)}`)
      .join(', ');
    const id = 1 + Math.max(0, ...pins.map(pin => pin.id));
    const series = [3, 4, 2, 1, 6].find(k => !pins.some(pin => pin.series === k)) ?? 6;
    this.store.update({pins: [...pins, {id, label: said || 'as in the text', series, run, shown: true}]});
  }

  /** A claim of an exercise: a wrong one is not told what would be right. */
  claim(text: string, about: string): Promise<Answer<ClaimAnswer>> {
    return this.asker.ask<ClaimAnswer>({do: 'claim', text, about, exercise: true});
  }
}

const withValue = (values: Record<string, string>, name: string, value: string | null): Record<string, string> => {
  const next = {...values};
  if (value === null) delete next[name];
  else next[name] = value;
  return next;
};
