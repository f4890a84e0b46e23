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
  PoseAnswer,
  RunAnswer,
  Scene,
  Section,
  SectionAnswer,
  Values,
} from './contract';
import type {Store} from './store';
import type {State} from './state';

export const noDuration = 'E0701';
const longest = 1_000_000; // characters of a model: as much as a session takes
const restAfter = 220,
  quickFrames = 160,
  fullFrames = 1500;

export interface Model {
  text: string;
  name: string;
  set?: Record<string, string>;
  start?: Record<string, string>;
  origin?: State['origin'];
}

/** What follows from the text and the values: asks for it when they change, and puts the answers into the state. */
export class Study {
  private resting = 0;
  private grabbed: {values: Values; start: Record<string, string>; moved: boolean} | null = null;
  private shown = false; // something of this model was shown: the clock goes on where it is

  constructor(
    readonly store: Store<State>,
    readonly asker: Asker,
    private readonly clock: Clock,
  ) {
    asker.onBusy(kind => store.update({busy: kind, progress: null}));
    store.watch(['busy', 'quick', 'text', 'openedText'], state => {
      document.body.dataset.settled = String(state.busy === null && !state.quick && state.text === state.openedText);
    });
  }

  get values(): Values {
    const {set, start, duration, mode} = this.store.state;
    return {set, start, ...(duration ? {run: duration} : {}), ...(mode ? {mode} : {})};
  }

  say(text: string, trouble = false): void {
    this.store.update({word: {text, trouble}});
  }

  // ------------------------------------------------------------------------------------------------------- the text

  /** Another model: nothing of the one before stays. */
  load({text, name, set = {}, start = {}, origin = null}: Model): void {
    this.shown = false;
    this.clock.play(false);
    this.clock.seek(0);
    this.store.update({
      text,
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
      charts: null,
      pins: [],
      deep: [],
      ...this.nothingFound(),
    });
    void this.readText();
  }

  edit(text: string): void {
    if (text === this.store.state.text) return;
    this.store.update({text});
    void this.readText();
  }

  private nothingFound(): Partial<State> {
    return {modes: null, phaseSpace: null, found: null, section: null, sectionTrouble: null};
  }

  private async readText(): Promise<void> {
    window.clearTimeout(this.resting);
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
      if (opened.kind !== 'cancelled') this.store.update({equationsTrouble: opened.trouble, readable: false});
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
    this.store.update(this.nothingFound());
    await this.askEquations();
    await this.askRun(fullFrames);
  }

  async askEquations(): Promise<void> {
    const {steps, text} = this.store.state;
    const answer = await this.asker.ask<EquationsAnswer>({do: 'equations', steps, ...this.values});
    if (text !== this.store.state.text) return;
    if (answer.ok) {
      this.store.update({equations: answer, equationsTrouble: null, deep: answer.diagnostics});
      if (!this.shown) document.title = `${answer.title || answer.name} – Maupertuis`;
    } else if (answer.kind !== 'cancelled') {
      if (this.dropForeignValues(answer)) return this.askEquations();
      this.store.update({equationsTrouble: answer.trouble, deep: answer.diagnostics ?? []});
    }
  }

  /** Values of names that the text has no more are let go, with a word. */
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
    this.store.update(next);
    this.say('Values of names that the text does not have any more were dropped.');
    return true;
  }

  async wantSteps(): Promise<void> {
    if (this.store.state.steps && this.store.state.equations?.derivation) return;
    this.store.update({steps: true});
    if (this.store.state.readable) await this.askEquations();
  }

  // ------------------------------------------------------------------------------------------------------- the motion

  private async askRun(frames: number): Promise<void> {
    const quick = frames < fullFrames;
    if (!this.store.state.opened?.readable) return;
    const answer = await this.asker.ask<RunAnswer>(
      {do: 'run', frames, budget: quick ? 1 : 20, ...this.values},
      {
        onMessage: message => {
          if (!quick && message.progress !== undefined) this.store.update({progress: message.progress});
        },
      },
    );
    if (answer.ok) this.showRun(answer, quick);
    else if (answer.kind !== 'cancelled' && !(quick && answer.kind === 'budget')) {
      this.dropForeignValues(answer);
      this.store.update({
        runTrouble: answer.trouble,
        quick: false,
        ...(answer.trouble.code === noDuration ? {run: null} : {}),
        deep:
          answer.diagnostics?.length && answer.trouble.code !== noDuration ? answer.diagnostics : this.store.state.deep,
      });
    }
  }

  private showRun(run: RunAnswer, quick: boolean): void {
    if (run.drawing)
      for (const element of run.drawing.elements) element.positions = element.positions.map(value => value ?? NaN);
    if (/^dimensionless\b/m.test(this.store.state.text)) run.independent.unit = '';
    const first = !this.shown;
    this.shown = true;
    this.clock.take(run, first);
    this.store.update({run, runTrouble: null, quick, pose: this.grabbed ? this.store.state.pose : null});
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (first && !still) this.clock.play(true);
  }

  /** Values changed: a quick run now, everything when they rest. */
  private valuesChanged(resting: boolean): void {
    window.clearTimeout(this.resting);
    if (resting) return void this.everything();
    void this.askRun(quickFrames);
    this.resting = window.setTimeout(() => void this.everything(), restAfter);
  }

  private async everything(): Promise<void> {
    this.store.update(this.nothingFound());
    await this.askRun(fullFrames);
    await this.askEquations();
  }

  setValue(name: string, value: string | null, resting: boolean): void {
    this.store.update({set: withValue(this.store.state.set, name, value)});
    this.valuesChanged(resting);
  }

  setStart(name: string, value: string | null, resting: boolean): void {
    this.store.update({start: withValue(this.store.state.start, name, value)});
    if (resting) this.clock.seek(0);
    this.valuesChanged(resting);
  }

  setDuration(duration: string): void {
    this.store.update({duration});
    this.valuesChanged(true);
  }

  setMode(mode: string): void {
    this.store.update({mode});
    void this.follow();
  }

  resetValues(): void {
    this.store.update({set: {}, start: {}, duration: ''});
    this.valuesChanged(true);
  }

  pin(): void {
    const {run, pins, set, start} = this.store.state;
    if (!run) return;
    if (pins.length >= 5) return this.say('Five runs are pinned; take one away first.', true);
    const said = [...Object.entries(set), ...Object.entries(start)]
      .slice(0, 3)
      .map(([name, value]) => `${name} = ${short(value)}`)
      .join(', ');
    const id = 1 + Math.max(0, ...pins.map(pin => pin.id));
    const series = [5, 3, 4, 2, 6].find(k => !pins.some(pin => pin.series === k)) ?? 6;
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
    const start = {...this.store.state.start};
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
    this.grabbed = {values: this.values, start, moved: false};
  }

  async drag(element: number, point: number, to: number[]): Promise<void> {
    const grabbed = this.grabbed;
    if (!grabbed) return;
    const answer = await this.asker.ask<PoseAnswer>({
      do: 'pose',
      budget: 2,
      drag: {element, point, to},
      ...grabbed.values,
      start: grabbed.start,
    });
    if (this.grabbed !== grabbed || !answer.ok) {
      if (!answer.ok && answer.kind !== 'cancelled' && answer.kind !== 'budget') this.say(answer.trouble.message, true);
      return;
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
    this.store.update({start: grabbed.start});
    this.clock.seek(0);
    window.clearTimeout(this.resting);
    await this.everything();
    this.store.update({pose: null});
    if (!this.store.state.runTrouble) this.clock.play(true);
  }

  // ------------------------------------------------------------------------------------------------------- questions

  async askModes(): Promise<void> {
    const answer = await this.asker.ask<ModesAnswer>({do: 'modes', ...this.values});
    if (answer.ok)
      for (const shape of answer.points.flatMap(point => point.shapes))
        for (const element of shape.drawing?.elements ?? [])
          element.positions = element.positions.map(value => value ?? NaN);
    this.take(answer, modes => ({modes}));
  }
  async askPhaseSpace(): Promise<void> {
    this.take(await this.asker.ask<{sections: Section[]}>({do: 'phase_space', ...this.values}), answer => ({
      phaseSpace: 'sections' in answer ? answer.sections : answer,
    }));
  }
  async askConserved(): Promise<void> {
    this.take(
      await this.asker.ask<{conserved: Conserved[]}>({do: 'conserved', budget: 60, ...this.values}),
      answer => ({found: 'conserved' in answer ? answer.conserved : answer}),
    );
  }

  async askSection(at: string, crossings: number): Promise<void> {
    this.store.update({section: null, sectionTrouble: null});
    const answer = await this.asker.ask<SectionAnswer>(
      {do: 'section', at, crossings, budget: 60, ...this.values},
      {
        onMessage: message => {
          if (message.section) this.store.update({section: message.section});
        },
      },
    );
    if (answer.ok) this.store.update({section: answer});
    else if (answer.kind !== 'cancelled') this.store.update({sectionTrouble: answer.trouble});
  }

  /** A claim of an exercise: a wrong one is not told what would be right. */
  claim(text: string): Promise<Answer<ClaimAnswer>> {
    return this.asker.ask<ClaimAnswer>({do: 'claim', text, exercise: true});
  }

  private take<T>(answer: Answer<T>, patch: (answer: T | Failure['trouble']) => Partial<State>): void {
    if (answer.ok) this.store.update(patch(answer));
    else if (answer.kind !== 'cancelled') this.store.update(patch(answer.trouble));
  }
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
