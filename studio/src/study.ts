import type {Asker} from './asker';
import type {Clock} from './clock';
import type {
  Answer,
  ClaimAnswer,
  Conserved,
  EquationsAnswer,
  Failure,
  ModesAnswer,
  OpenAnswer,
  PathsAnswer,
  PoseAnswer,
  Request,
  RunAnswer,
  Scene,
  Section,
  SectionAnswer,
  Trouble,
  Values,
} from './contract';
import type {Ends} from './lines';
import type {Store} from './store';
import type {State} from './state';

export const noDuration = 'E0701',
  heldIntegral = 'E0244';

/** The model is about paths between two ends (`path from …`), and has no motion from a start. */
export const betweenEnds = ({text, runTrouble}: State): boolean =>
  runTrouble?.code === heldIntegral || (runTrouble?.code === noDuration && /^path\b/m.test(text));
/** The equations are those of motions in time: no other variable is declared in its place. Without it no modes. */
export const inTime = ({text}: State): boolean => !/^independent\b(?!\s+t\b)/m.test(text);

export const longest = 1_000_000; // characters of a model: as much as a session takes
const restAfter = 220, // ms without a move of a slider
  lateAfter = 500, // ms that an older answer may stand in the place of the one that is asked for
  quick = {frames: 160, budget: 1},
  full = {frames: 1500, budget: 20};

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
  private changes = 0;
  private equationsOf = 0; // of `texts`: what the equations that are shown were asked for
  private runOf = 0; // of `changes`
  private troubleOf = 0; // of `changes`: what the trouble of the run was asked for
  private resting = 0; // a timer, while a slider moves
  private late = 0; // a timer, while something that is shown is of former values
  private pending = new Map<string, number>(); // searches on their way, of `changes`
  private grabbed: {
    values: Values;
    start: Record<string, string>;
    velocities: Record<string, number>; // SI, before the drag: each place of it begins with these
    moved: boolean;
    told: boolean;
  } | null = null;
  private shown = false; // something of this model was shown: the clock goes on where it is

  constructor(
    readonly store: Store<State>,
    readonly asker: Asker,
    private readonly clock: Clock,
  ) {
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
      ...(forces === 'all' ? {forces: true} : {}),
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
    this.grabbed = null;
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
      pose: this.grabbed ? this.store.state.pose : null,
    });
    this.arrived();
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (first && !still) this.clock.play(true);
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

  // --------------------------------------------------------------------------------------------------------- dragging

  /**
   * Takes hold of the system at the moment that is shown. At its start it keeps its velocities; in flight it is held
   * still.
   */
  grab(): void {
    const {run, equations} = this.store.state,
      {s} = this.clock;
    const start = {...this.store.state.start},
      velocities: Record<string, number> = {};
    for (const c of equations?.coordinates ?? []) {
      const v = s > 0 ? 0 : run?.start[c.name + "'"];
      if (typeof v === 'number') velocities[c.name + "'"] = v;
    }
    if (run && equations && s > 0) {
      const row = nearestRow(run, s);
      for (const c of equations.coordinates) {
        const column = run.columns.findIndex(other => other.name === c.name),
          value = column < 0 ? null : run.values[column][row];
        if (value === null) continue;
        start[c.name] = withUnit(value, c.unit);
        start[c.name + "'"] = withUnit(0, c.velocity_unit);
      }
    }
    this.clock.play(false);
    this.grabbed = {values: this.values, start, velocities, moved: false, told: false};
  }

  async drag(element: number, point: number, to: number[]): Promise<void> {
    const grabbed = this.grabbed;
    if (!grabbed) return;
    const answer = await this.asker.ask<PoseAnswer>({
      do: 'pose',
      budget: 2,
      drag: {element, point, to, velocities: grabbed.velocities},
      ...grabbed.values,
      start: grabbed.start,
    });
    if (this.grabbed !== grabbed) return;
    if (!answer.ok) {
      if (answer.kind === 'cancelled' || grabbed.told) return;
      grabbed.told = true;
      return this.say(answer.kind === 'budget' ? tooFar : `${answer.trouble.message} ${answer.trouble.help}`, true);
    }
    for (const c of this.store.state.equations?.coordinates ?? []) {
      const q = answer.start[c.name],
        v = answer.start[c.name + "'"];
      grabbed.moved ||=
        typeof q === 'number' &&
        q !==
          (grabbed.start[c.name] === undefined
            ? this.store.state.run?.start[c.name]
            : Number.parseFloat(grabbed.start[c.name]));
      if (q !== null && q !== undefined) grabbed.start[c.name] = withUnit(q, c.unit);
      if (v !== null && v !== undefined) grabbed.start[c.name + "'"] = withUnit(v, c.velocity_unit);
    }
    this.store.update({pose: posed(answer.drawing, this.store.state.run?.drawing ?? null)});
  }

  async release(moved: boolean): Promise<void> {
    const grabbed = this.grabbed;
    this.grabbed = null;
    if (!grabbed || !moved) return this.store.update({pose: null});
    if (!grabbed.moved) {
      this.say('Its constraints hold it where it is.');
      return this.store.update({pose: null});
    }
    this.clock.seek(0);
    this.change({start: grabbed.start, ...this.nothingFound()}, {ofText: false});
    const {changes} = this;
    await this.everything();
    if (changes !== this.changes) return;
    this.store.update({pose: null});
    if (!this.store.state.runTrouble) this.clock.play(true);
  }

  // ------------------------------------------------------------------------------------------------------- questions

  askModes(): Promise<void> {
    return this.search<ModesAnswer>({do: 'modes'}, modes => {
      if ('points' in modes)
        for (const shape of modes.points.flatMap(point => point.shapes))
          for (const element of shape.drawing?.elements ?? [])
            element.positions = element.positions.map(value => value ?? NaN);
      return {modes};
    });
  }
  askPhaseSpace(): Promise<void> {
    return this.search<{sections: Section[]}>({do: 'phase_space'}, answer => ({
      phaseSpace: 'sections' in answer ? answer.sections : answer,
    }));
  }
  askPaths(): Promise<void> {
    return this.search<PathsAnswer>({do: 'paths', budget: 20}, paths => ({paths}));
  }
  askConserved(): Promise<void> {
    return this.search<{conserved: Conserved[]}>({do: 'conserved', budget: 60}, answer => ({
      found: 'conserved' in answer ? answer.conserved : answer,
    }));
  }

  /** What takes its time and is of the values that stand there now; it is asked for once. */
  private async search<T extends object>(
    request: Request,
    patch: (answer: T | Trouble) => Partial<State>,
  ): Promise<void> {
    const {changes} = this;
    if (this.pending.get(request.do) === changes) return;
    this.pending.set(request.do, changes);
    const answer = await this.asker.ask<T>({...request, ...this.values});
    if (changes !== this.changes) return;
    this.pending.delete(request.do);
    if (answer.ok) this.store.update(patch(answer));
    else if (answer.kind !== 'cancelled') this.store.update(patch(answer.trouble));
  }

  async askSection(at: string, crossings: number): Promise<void> {
    const {changes} = this;
    this.store.update({section: null, sectionTrouble: null, sectionGone: false});
    const answer = await this.asker.ask<SectionAnswer>(
      {do: 'section', at, crossings, budget: 60, ...this.values},
      {
        onMessage: message => {
          if (message.section && changes === this.changes) this.store.update({section: message.section});
        },
      },
    );
    if (changes !== this.changes) return;
    if (answer.ok) this.store.update({section: answer});
    else if (answer.kind !== 'cancelled') this.store.update({sectionTrouble: answer.trouble});
  }

  /** A claim of an exercise: a wrong one is not told what would be right. */
  claim(text: string, about: string): Promise<Answer<ClaimAnswer>> {
    return this.asker.ask<ClaimAnswer>({do: 'claim', text, about, exercise: true});
  }
}

const tooFar = 'The constraints could not be solved in time for this place. Move more slowly, or less far.';

/** It ended with its budget, and holds what was computed until then. */
export const unfinished = (run: RunAnswer): boolean => run.ending.kind === 'interrupted';

const few = 50; // points, of which a range says little

/**
 * The name of a curve that turns more often than it has points, so that what is drawn is a slower one: between many
 * neighbouring points its velocity alone would take it through half of its range; of a few points, as a run has that
 * was cut short, the velocities lead elsewhere than to the next one. Null where all are drawn finely.
 */
export function drawnTooCoarsely({columns, times, values}: RunAnswer): string | null {
  const numbersOf = (k: number): number[] => values[k].map(value => value ?? NaN);
  for (const [k, {name}] of columns.entries()) {
    const rate = columns.findIndex(column => column.name === `${name}'`);
    if (rate < 0 || times.length < 2) continue;
    const x = numbersOf(k).filter(Number.isFinite),
      range = x.reduce((a, b) => Math.max(a, b), -Infinity) - x.reduce((a, b) => Math.min(a, b), Infinity),
      rates = numbersOf(rate),
      step = (i: number): number => times[i] - times[i - 1];
    if (times.length < few) {
      const [all, way] = [numbersOf(k), (i: number): number => (step(i) * (rates[i - 1] + rates[i])) / 2];
      if (times.some((_, i) => i > 0 && Math.abs(all[i] - all[i - 1] - way(i)) > 2 * range)) return name;
      continue;
    }
    const coarse = rates.filter((v, i) => i > 0 && Math.abs(v * step(i)) > 0.5 * range);
    if (coarse.length > 0.1 * times.length) return name;
  }
  return null;
}

const withValue = (values: Record<string, string>, name: string, value: string | null): Record<string, string> => {
  const next = {...values};
  if (value === null) delete next[name];
  else next[name] = value;
  return next;
};

export const withUnit = (value: number, unit: string): string =>
  `${Number(value.toPrecision(12))}${unit ? ' ' + unit : ''}`;
export const short = (value: string): string =>
  value.replace(/-?\d+\.\d{4,}/, number => String(Number(Number(number).toPrecision(4))));

/** The row whose time is next to `s` seconds after the first. */
export function nearestRow(run: {times: number[]}, s: number): number {
  const {times} = run,
    way = times[times.length - 1] < times[0] ? -1 : 1;
  let low = 0,
    high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (way * (times[middle] - times[0]) <= s) low = middle;
    else high = middle;
  }
  return s - way * (times[low] - times[0]) < way * (times[high] - times[0]) - s ? low : high;
}

/** The moment as the run draws it: sizes of bobs and of the ground come from a whole motion. */
function posed(pose: Scene | null, run: Scene | null): Scene | null {
  if (!pose) return null;
  for (const one of pose.elements) one.positions = one.positions.map(value => value ?? NaN);
  const alike =
    run &&
    run.elements.length === pose.elements.length &&
    run.elements.every((one, i) => one.kind === pose.elements[i].kind && one.points === pose.elements[i].points);
  if (!alike) return pose;
  const elements = run.elements.map((one, i) =>
    one.still && pose.elements[i].still
      ? one
      : {...one, still: pose.elements[i].still, positions: pose.elements[i].positions},
  );
  return {...run, times: [0], follow: pose.follow, elements};
}
