import type {Check, Conserved, Happening, Line, ModesAnswer, Section, Trouble} from '../contract';
import {byId, h, prose} from '../dom';
import {loopDrawing} from '../drawing/loop';
import {drawnTooCoarsely, unfinished, withUnit} from '../runs';
import {betweenEnds, hasMistake, inTime, noDuration, type State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {modeOptions, numbers, pretty} from './words';
import {copyButton, lineElement, sectionsElements} from './formulas';

/** The words of the page for what went wrong: what, why, what helps. */
export function troubleElement(trouble: Trouble, severity = 'error'): HTMLElement {
  return h(
    'div',
    {class: `message ${severity}`},
    h('p', {class: 'what'}, ...prose(trouble.message)),
    trouble.reason && h('p', {}, ...prose(trouble.reason)),
    trouble.help && h('p', {class: 'help'}, ...prose(trouble.help)),
  );
}

const sameLine = (a: Line, b: Line): boolean => a === b || a.mathml === b.mathml;
const isTrouble = (x: object): x is Trouble => 'message' in x;

const slowly: Trouble = {
    code: '',
    message: 'This motion takes longer than a slider waits.',
    reason: 'What is drawn belongs to the values before.',
    help: 'Let the values rest: then it is computed in full. A shorter run follows the slider: `Run` among the values.',
  },
  outOfTime: Trouble = {
    code: '',
    message: 'The motion was not finished within the time of a run.',
    reason: 'Every question has a time, so that the page stays alive; this is what was computed until then.',
    help: 'A shorter run is finished: `Run` among the values says how long.',
  };

const tooCoarse = (name: string, moments: number): Trouble => ({
  code: '',
  message: `\`${name}\` turns more often than its curve has points: what is drawn is not the motion.`,
  reason: `The run is drawn by ${moments} moments, and between two of them this goes most of its way.`,
  help: 'A shorter run shows it: `Run` among the values says how long.',
});

/** A panel whose content is asked for when it is opened. */
function onOpening(id: string, ask: () => void): void {
  byId<HTMLDetailsElement>(id).addEventListener('toggle', () => {
    if (byId<HTMLDetailsElement>(id).open) ask();
  });
}
const isOpen = (id: string): boolean => byId<HTMLDetailsElement>(id).open;

/** Everything that is known about the system and its motion, in words and formulas. */
export class EquationsPanel {
  private readonly say = (text: string): void => this.study.say(text);
  private loops: (() => void)[] = [];
  private conservedOf: {list: Conserved[]; found: State['found']; any: boolean} | null = null; // what is shown
  private conservedNumbers: HTMLElement[] = [];

  constructor(
    private readonly store: Store<State>,
    private readonly study: Study,
  ) {
    store.watch(['equations', 'equationsTrouble'], state => this.equations(state));
    store.watch(['equations'], state => {
      this.derivation(state);
      this.facts(state);
    });
    store.watch(['equations', 'run', 'found'], state => this.conserved(state));
    store.watch(['run', 'runTrouble', 'slow', 'quick', 'paths'], state => this.motion(state));
    store.watch(['modes'], state => this.modes(state));
    store.watch(['phaseSpace'], state => this.phaseSpace(state));
    store.watch(['readable', 'opened', 'equations', 'equationsLate', 'runLate'], state => this.stale(state));
    store.watch(['equations'], state => {
      byId('modes').hidden = !inTime(state);
    });
    onOpening('derivation', () => void study.wantSteps());
    onOpening('modes', () => this.asked());
    onOpening('phase-space', () => this.asked());
    store.watch(['answered', 'modes', 'phaseSpace', 'equations', 'paths', 'runTrouble'], () => this.asked());
  }

  /** What is of a former text or of former values looks so, and is told where it is the text. */
  private stale(state: State): void {
    const {equations, equationsLate, runLate} = state,
      mistake = hasMistake(state) && equations !== null,
      place = byId('stale');
    byId('equations').classList.toggle('stale', mistake || equationsLate);
    for (const part of ['conserved', 'run-facts']) byId(part).classList.toggle('stale', runLate);
    place.hidden = !(mistake || equationsLate);
    place.textContent = mistake
      ? 'The text has a mistake. What stands here and in the drawing belongs to the last text without one.'
      : 'What stands here belongs to the text before.';
  }

  /** What stands open and is not there is asked for, when the values rest. */
  private asked(): void {
    const {answered, modes, phaseSpace, equations} = this.store.state;
    if (!equations || !answered) return;
    if (isOpen('modes') && modes === null) void this.study.searches.modes();
    if (isOpen('phase-space') && phaseSpace === null) void this.study.searches.phaseSpace();
    if (betweenEnds(this.store.state) && this.store.state.paths === null) void this.study.searches.paths();
  }

  private equations({equations, equationsTrouble}: State): void {
    const body = byId('equations-body');
    byId('stage-title').textContent = equations ? equations.title || equations.name : '';
    byId('stage-source').textContent = equations?.source ?? '';
    if (!equations)
      return body.replaceChildren(
        ...(equationsTrouble ? [troubleElement(equationsTrouble)] : [h('p', {class: 'muted'}, 'No equations yet.')]),
      );
    const {in_rates: rates} = equations,
      first = rates?.equations ?? equations.equations,
      all = [...first, ...(rates?.definitions ?? []),
             ...(rates ? equations.equations : []), ...equations.intermediates];
    const withThese =
      equations.intermediates.length > 0
        ? h('div', {class: 'where'}, h('p', {class: 'muted'}, 'with'), ...equations.intermediates.map(lineElement))
        : '';
    const where = equations.definitions.length + equations.energies.length > 0;
    body.replaceChildren(
      equationsTrouble ? troubleElement(equationsTrouble) : '',
      equations.holds ? this.modeOfEquations(equations.holds, equations.modes ?? []) : '',
      h('div', {class: 'numbered'}, ...first.map(lineElement)),
      rates
        ? h('div', {class: 'where'}, h('p', {class: 'muted'}, 'with the rates'), ...rates.definitions.map(lineElement))
        : withThese,
      rates
        ? h(
            'details',
            {class: 'inner'},
            h('summary', {}, 'In the coordinates'),
            ...equations.equations.map(lineElement),
            withThese,
          )
        : '',
      where
        ? h(
            'details',
            {class: 'inner', open: true},
            h('summary', {}, equations.energies_title || 'Where'),
            ...equations.definitions.map(lineElement),
            ...equations.energies.map(lineElement),
          )
        : '',
      h(
        'div',
        {class: 'tools'},
        copyButton(() => all, this.say),
      ),
    );
  }

  /** Equations of contacts and friction belong to one mode, which is told and can be chosen. */
  private modeOfEquations(holds: string, modes: string[]): HTMLElement {
    const {mode} = this.store.state,
      choose = (event: Event): void => this.study.setMode((event.target as HTMLSelectElement).value);
    return h(
      'div',
      {class: 'message holds'},
      h('p', {}, ...prose(holds), mode ? ' The motion stays in it, whatever the forces are.' : ''),
      h(
        'p',
        {},
        h('label', {for: 'mode-of-equations'}, 'Equations and motion: '),
        h('select', {id: 'mode-of-equations', onchange: choose}, ...modeOptions(modes, mode)),
      ),
    );
  }

  private derivation({equations, steps}: State): void {
    const body = byId('derivation-body'),
      opened = new Set([...body.querySelectorAll('details[open] > summary')].map(one => one.textContent));
    if (!equations?.derivation) return body.replaceChildren(h('p', {class: 'muted'}, steps ? 'It comes …' : ''));
    const parts = sectionsElements(equations.derivation, this.say);
    for (const part of parts) if (opened.has(part.querySelector('summary')!.textContent)) part.setAttribute('open', '');
    const all = h(
      'button',
      {
        type: 'button',
        class: 'quiet',
        onclick: () => {
          const open = !parts.every(part => part.hasAttribute('open'));
          for (const part of parts) part.toggleAttribute('open', open);
          all.textContent = open ? 'Fold all' : 'Unfold all';
        },
      },
      'Unfold all',
    );
    const notes = (list: string[] | undefined): HTMLElement[] =>
      (list ?? []).map(text => h('p', {class: 'note'}, ...prose(text)));
    body.replaceChildren(
      h(
        'div',
        {class: 'tools'},
        all,
        copyButton(() => equations.derivation!.flatMap(part => part.lines), this.say),
      ),
      ...notes(equations.first_notes),
      ...parts,
      ...notes(equations.last_notes),
    );
  }

  private facts({equations}: State): void {
    const body = byId('certificate-body'),
      badge = byId('certified');
    badge.hidden = !equations;
    if (!equations) return body.replaceChildren();
    badge.className = equations.certified ? 'badge good' : 'badge bad';
    badge.textContent = equations.certified ? '✓ certified' : '✗ not certified';
    const summary = h(
      'dl',
      {},
      ...equations.summary.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, ...prose(value))]),
    );
    body.replaceChildren(summary, ...(equations.certificate.length ? [checks(equations.certificate)] : []));
  }

  private conserved(state: State): void {
    const {equations, run, found, runText, equationsText} = state,
      ofRun = runText === equationsText ? run : null; // a run of the text before has its own
    const list: Conserved[] = Array.isArray(found)
      ? found
      : ofRun?.conserved.length
        ? ofRun.conserved
        : (equations?.conserved ?? []);
    const measured = new Map(ofRun?.conserved.map(c => [c.sentence, c])),
      numbersOf = (c: Conserved): string[] => {
        const {value, drift} = measured.get(c.sentence) ?? c;
        return [value, drift];
      };
    // While values move the formulas stay, which may be long, and the numbers change.
    const before = this.conservedOf,
      same =
        before?.found === found &&
        before.any === (equations !== null) &&
        before.list.length === list.length &&
        list.every((c, i) => c.sentence === before.list[i].sentence && sameLine(c.formula, before.list[i].formula));
    if (!same) this.buildConserved(list, state);
    this.conservedOf = {list, found, any: equations !== null};
    list.forEach((c, i) => this.conservedNumbers[i].replaceChildren(...driftElements(numbersOf(c))));
  }

  private buildConserved(list: Conserved[], {equations, found}: State): void {
    this.conservedNumbers = list.map(() => h('p', {class: 'drift'}));
    const rows = list.map((c, i) =>
      h(
        'div',
        {class: 'conserved'},
        c.sentence && h('p', {class: 'sentence'}, ...prose(c.sentence)),
        lineElement({...c.formula, sentence: ''}),
        this.conservedNumbers[i],
      ),
    );
    const search = h(
      'button',
      {type: 'button', class: 'quiet', onclick: () => void this.study.searches.conserved()},
      'Search for more',
    );
    byId('conserved-body').replaceChildren(
      ...(rows.length
        ? rows
        : equations
          ? [h('p', {class: 'muted'}, 'None was found among the energy and the momenta.')]
          : []),
      found && isTrouble(found) ? troubleElement(found) : '',
      equations ? h('div', {class: 'tools'}, search) : '',
    );
  }

  private motion(state: State): void {
    const {run, runTrouble, slow, quick} = state,
      coarse = run && !quick ? drawnTooCoarsely(run) : null;
    const facts = run
      ? h('dl', {}, ...run.statistics.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, numbers(value))]))
      : '';
    const ending =
      run && unfinished(run)
        ? troubleElement(outOfTime, 'warning')
        : run && !run.ending.ok
          ? troubleElement(
              {code: '', message: `The motion ended early: ${run.ending.kind}.`, reason: run.ending.reason, help: ''},
              '',
            )
          : '';
    const lost = run?.uncertain
      ? h(
          'div',
          {class: 'message'},
          h(
            'p',
            {class: 'what'},
            `From ${run.independent.name} = ` +
              `${withUnit(Number(run.uncertain.from.toPrecision(3)), run.independent.unit)} on no digit of ` +
              `${run.uncertain.everything ? 'the motion' : run.uncertain.columns.map(pretty).join(', ')} is certain.`,
          ),
        )
      : '';
    byId('run-facts').hidden = betweenEnds(state);
    byId('motion-body').replaceChildren(
      runTrouble ? troubleElement(runTrouble) : '',
      ending,
      run && coarse ? troubleElement(tooCoarse(coarse, run.times.length), 'warning') : '',
      lost,
      facts,
      run?.happenings.length ? happenings(run.happenings, run.first_mode) : '',
    );
    byId('stage-trouble').replaceChildren(
      slow
        ? troubleElement(slowly, 'warning')
        : runTrouble
          ? this.withoutMotion(state) ?? troubleElement(runTrouble)
          : ending
            ? ending.cloneNode(true)
            : lost && !coarse
              ? lost.cloneNode(true)
              : '',
      !slow && !runTrouble && run && coarse ? troubleElement(tooCoarse(coarse, run.times.length), 'warning') : '',
    );
  }

  /** What to do where the model has no motion yet, or none at all. */
  private withoutMotion(state: State): HTMLElement | null {
    if (betweenEnds(state)) return this.withPaths(state);
    return state.runTrouble?.code === noDuration ? this.withoutDuration() : null;
  }

  private withPaths(state: State): HTMLElement {
    const carryOut = (): void => {
      this.store.update({pane: 'equations'});
      byId<HTMLDetailsElement>('expectations').open = true;
      byId('expectations').scrollIntoView({block: 'nearest'});
    };
    return h(
      'div',
      {class: 'message'},
      h('p', {class: 'what'}, 'This model is about paths between two ends: it has no motion from a start.'),
      h(
        'p',
        {},
        ...prose(
          'Below are the paths on which the action is stationary. ' +
            'Its `expect` lines ask for the action, the index and places of a path. ',
        ),
        h('button', {type: 'button', onclick: carryOut}, 'Carry them out'),
      ),
      this.paths(state),
      inTime(state) && h('p', {}, ...prose('With lines `start` and `run` it has a motion beside its paths.')),
    );
  }

  private paths({paths}: State): HTMLElement {
    if (paths === null) return h('p', {class: 'muted'}, 'They are sought …');
    if (isTrouble(paths)) return troubleElement(paths);
    return h(
      'div',
      {class: 'paths'},
      ...paths.figures.map(({caption, svg}) =>
        h('figure', {class: 'given'}, h('div', {html: svg}), h('figcaption', {}, ...prose(caption))),
      ),
      ...paths.paths.flatMap(path => [
        h('h3', {}, path.title),
        h('dl', {}, ...path.facts.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, numbers(value))])),
      ]),
      h('p', {class: 'muted'}, ...prose(paths.search)),
    );
  }

  private withoutDuration(): HTMLElement {
    return h(
      'div',
      {class: 'message'},
      h('p', {class: 'what'}, 'The text does not say how long to run.'),
      h(
        'p',
        {},
        'A line such as ',
        h('code', {}, 'run 10 s'),
        ' says it. ',
        h('button', {type: 'button', onclick: () => this.study.setDuration('10 s')}, 'Run 10 s'),
      ),
    );
  }

  private modes({modes}: State): void {
    for (const stop of this.loops) stop();
    this.loops = [];
    const body = byId('modes-body');
    if (modes === null)
      return body.replaceChildren(h('p', {class: 'muted'}, 'Asked for when this is opened and the values rest.'));
    if (isTrouble(modes)) return body.replaceChildren(troubleElement(modes));
    body.replaceChildren(...this.points(modes));
  }

  private points(modes: ModesAnswer): (Node | string)[] {
    return [
      ...modes.points.flatMap(point => [
        h('h3', {}, pretty(point.name), h('span', {class: point.stable ? 'good' : 'bad'}, ` ${point.stability}`)),
        h(
          'div',
          {class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'Frequencies and damping'},
          h(
            'table',
            {},
            h('thead', {}, h('tr', {}, ...['', 'ω', 'f', 'period', 'damping'].map(t => h('th', {}, t)))),
            h(
              'tbody',
              {},
              ...point.rows.map(row =>
                h(
                  'tr',
                  {},
                  ...[row.kind, row.frequency, row.hertz, row.period, row.damping].map(t => h('td', {}, numbers(t))),
                ),
              ),
            ),
          ),
        ),
        h('div', {class: 'shapes'}, ...point.shapes.map(shape => this.shape(shape))),
        h('details', {class: 'inner'}, h('summary', {}, 'Linearized equations'), ...point.formulas.map(lineElement)),
      ]),
      modes.search ? h('p', {class: 'muted'}, ...prose(modes.search)) : '',
      modes.points.length ? '' : h('p', {class: 'muted'}, 'There is no equilibrium here.'),
    ];
  }

  private shape({caption, drawing, svg}: ModesAnswer['points'][number]['shapes'][number]): HTMLElement {
    if (!drawing) return h('figure', {}, h('div', {html: svg}), h('figcaption', {}, ...prose(caption)));
    const {element, stop} = loopDrawing(drawing, caption);
    this.loops.push(stop);
    return element;
  }

  private phaseSpace({phaseSpace}: State): void {
    const body = byId('phase-space-body');
    if (phaseSpace === null)
      return body.replaceChildren(h('p', {class: 'muted'}, 'Asked for when this is opened and the values rest.'));
    if (!Array.isArray(phaseSpace)) return body.replaceChildren(troubleElement(phaseSpace));
    body.replaceChildren(...sectionsElements(phaseSpace as Section[], this.say));
    body.querySelector('details')?.setAttribute('open', '');
  }
}

const driftElements = ([value, drift]: string[]): HTMLElement[] =>
  [
    ['value ', value],
    ['drift ', drift],
  ].flatMap(([name, text]) => (text ? [h('span', {}, name, h('b', {}, numbers(text)))] : []));

function checks(list: Check[]): HTMLElement {
  return h(
    'ul',
    {class: 'checks'},
    ...list.map(check => {
      const mark = !check.applies
        ? ['muted', '–', 'does not apply']
        : check.passed
          ? ['good', '✓', 'passed']
          : ['bad', '✗', 'failed'];
      return h(
        'li',
        {},
        h('span', {class: mark[0], role: 'img', 'aria-label': mark[2]}, mark[1]),
        h('span', {}, ...prose(check.statement)),
        h('span', {class: 'muted'}, check.applies ? check.verdict : ''),
      );
    }),
  );
}

function happenings(list: Happening[], first: string): HTMLElement {
  const most = 200,
    rows = list
      .slice(0, most)
      .map(one =>
        h(
          'tr',
          {},
          h('td', {class: 'number'}, String(Number(one.t.toPrecision(6)))),
          h('td', {}, `${one.what} ${one.name}`),
          h('td', {}, one.mode),
          h('td', {}, one.remark),
        ),
      );
  return h(
    'details',
    {class: 'inner', open: list.length <= 12},
    h('summary', {}, `Events and modes (${list.length})`),
    first && h('p', {class: 'muted'}, `It begins ${first}.`),
    h(
      'div',
      {class: 'scroll', tabindex: 0, role: 'group', 'aria-label': 'Events'},
      h(
        'table',
        {},
        h('thead', {}, h('tr', {}, ...['t in s', 'what', 'then', ''].map(t => h('th', {}, t)))),
        h('tbody', {}, ...rows),
      ),
    ),
    list.length > most && h('p', {class: 'muted'}, `and ${list.length - most} more`),
  );
}
