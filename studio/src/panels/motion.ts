import maupScene from '../../../src/report/page/scene.js';
import type {Clock} from '../clock';
import type {Scene, SceneElement} from '../contract';
import {byId, h, icon} from '../dom';
import {numbers, pretty, raised} from './words';
import type {Stage} from '../drawing/stage';
import {betweenEnds, hasMistake, inTime, type State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {troubleElement} from './equations';

function speedText(speed: number): string {
  if (speed >= 1e-3 && speed < 1e6) return `× ${speed.toLocaleString('en')}`;
  const [mantissa, exponent] = speed.toExponential().split('e');
  return `× ${mantissa === '1' ? '' : mantissa + ' · '}10${raised(exponent.replace('+', ''))}`;
}

const icons = {play: 'M6 4v16l14-8z', pause: 'M6 4h4v16H6zM14 4h4v16h-4z', start: 'M5 4h3v16H5zM20 4v16L9 12z'};

/** Play, scrub, speed, trails, pinned runs, and the Poincaré section. */
export class MotionPanel {
  private offered = 0;
  private offeredSection = '';

  constructor(
    private readonly store: Store<State>,
    private readonly study: Study,
    private readonly clock: Clock,
    private readonly stage: Stage,
  ) {
    this.transport();
    clock.onTick(() => this.tick());
    store.watch(['run', 'runTrouble', 'opened', 'readable', 'runLate', 'forces'], state => this.shown(state));
    store.watch(['pins'], state => this.pins(state));
    store.watch(['section', 'sectionTrouble', 'sectionGone', 'busy'], state => this.section(state));
    store.watch(['equations', 'runTrouble'], () => this.sectionPlace());
    this.sectionForm();
  }

  private transport(): void {
    const {clock, store} = this;
    byId('to-start').append(icon(icons.start));
    byId('play').addEventListener('click', () => clock.play(!clock.playing));
    byId('to-start').addEventListener('click', () => clock.seek(0));
    byId('scrub').addEventListener('input', event => {
      clock.play(false);
      clock.seek(Number((event.target as HTMLInputElement).value) * clock.duration);
    });
    byId('speed').addEventListener('change', event => {
      clock.rate = Number((event.target as HTMLSelectElement).value);
    });
    byId('repeat').addEventListener('change', event => {
      clock.repeat = (event.target as HTMLInputElement).checked;
    });
    byId('trail').addEventListener('change', event =>
      store.update({trail: (event.target as HTMLSelectElement).value as State['trail']}),
    );
    byId('forces').addEventListener('change', event =>
      this.study.showForces((event.target as HTMLSelectElement).value as State['forces']),
    );
    byId('home-view').addEventListener('click', () => {
      this.stage.camera.reset();
      this.stage.draw();
    });
    byId('pin-button').addEventListener('click', () => this.study.pin());
  }

  private tick(): void {
    const {clock} = this,
      digits = Math.max(0, Math.min(9, 3 - Math.floor(Math.log10(clock.duration || 1))));
    const unit = this.store.state.run?.independent.unit ?? '',
      text = `${clock.now.toFixed(digits)}${unit ? ' ' + unit : ''}`;
    byId('time').textContent = text;
    const scrub = byId<HTMLInputElement>('scrub'),
      play = byId('play');
    scrub.value = clock.duration > 0 ? String(clock.s / clock.duration) : '0';
    scrub.setAttribute('aria-valuetext', text);
    if (play.dataset.playing !== String(clock.playing)) {
      play.dataset.playing = String(clock.playing);
      play.setAttribute('aria-label', clock.playing ? 'Pause' : 'Play');
      play.replaceChildren(icon(clock.playing ? icons.pause : icons.play));
    }
    if (this.offered !== clock.pleasant) this.offerSpeeds();
    const speed = byId<HTMLSelectElement>('speed');
    if (speed.value !== String(clock.rate)) speed.value = String(clock.rate);
  }

  private offerSpeeds(): void {
    this.offered = this.clock.pleasant;
    byId('speed').replaceChildren(
      ...[0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10].map(factor => {
        const speed = this.offered * factor;
        return h(
          'option',
          {value: speed, selected: speed === this.clock.rate},
          speedText(Number(speed.toPrecision(2))),
        );
      }),
    );
  }

  /** What the arrows are, each with its colour, and how long a force is. */
  private legend({run, forces}: State): void {
    const list = byId('force-legend'),
      drawing = run?.drawing,
      arrows = drawing?.elements.filter(e => e.kind === 'arrow') ?? [];
    list.hidden = forces !== 'all' || !drawing;
    if (list.hidden || !drawing) return;
    const entry = (e: SceneElement): HTMLElement =>
      h('li', {class: `s${maupScene.forceSeries(e) + 1}`}, h('span', {class: 'dot', 'aria-hidden': 'true'}), nameOf(e));
    const seen = new Map(arrows.map(e => [nameOf(e), e]));
    const scale = drawing.metresANewton,
      longest = scale ? lengthOfArrows(drawing) / scale : 0,
      unit = drawing.dimensionless ? '' : ' N';
    list.replaceChildren(
      ...[...seen.values()].map(entry),
      ...(longest > 0 ? [h('li', {}, `longest arrow: ${Number(longest.toPrecision(3))}${unit}`)] : []),
      ...(drawing.largestTorque
        ? [h('li', {}, `three quarters of a turn: ${Number(drawing.largestTorque.toPrecision(3))}${unit && ' N m'}`)]
        : []),
      ...(drawing.unplacedForces
        ? [h('li', {}, `no arrow alone does what these do: ${drawing.unplacedForces.map(pretty).join(', ')}`)]
        : []),
      ...(arrows.length === 0 && !drawing.unplacedForces ? [h('li', {}, 'No force acts in this model.')] : []),
    );
  }

  private shown(state: State): void {
    const {run, runTrouble, runLate} = state;
    const drawing = run?.drawing,
      none = byId('no-drawing');
    byId('drawing').hidden = !drawing;
    document.body.dataset.drawing = String(Boolean(drawing));
    none.textContent = drawing
      ? ''
      : run
        ? run.figures.length
          ? ''
          : 'There is nothing to draw: the model has neither points nor bodies. ' +
            'A line such as point P at (x, 0) shows one.'
        : runTrouble
          ? ''
          : 'No motion yet.';
    none.hidden = none.textContent === '';
    const mistake = hasMistake(state);
    byId('motion').classList.toggle('stale', runLate || mistake);
    byId('stage-stale').hidden = !(mistake && run);
    byId('transport').hidden = !run;
    byId('trail-label').hidden = !drawing;
    byId('forces-label').hidden = !drawing;
    this.legend(state);
    byId('home-view').hidden = !drawing;
    if (drawing)
      byId('drawing').setAttribute(
        'aria-label',
        `Drawing of the system in motion. ${drawing.dimension === 3 ? 'Drag to turn it. ' : ''}Drag a body to set it.`,
      );
    this.tick();
  }

  private pins({pins}: State): void {
    byId('pins').replaceChildren(
      ...pins.map(pin => {
        const set = (patch: Partial<typeof pin>): void =>
          this.store.update({pins: this.store.state.pins.map(one => (one.id === pin.id ? {...one, ...patch} : one))});
        return h(
          'li',
          {class: `s${pin.series + 1}`},
          h(
            'label',
            {},
            h('input', {
              type: 'checkbox',
              checked: pin.shown,
              onchange: (event: Event) => set({shown: (event.target as HTMLInputElement).checked}),
            }),
            h('span', {class: 'dot', 'aria-hidden': 'true'}),
            pin.label,
          ),
          h(
            'button',
            {
              type: 'button',
              class: 'icon',
              'aria-label': `Take away the run with ${pin.label}`,
              onclick: () => this.store.update({pins: this.store.state.pins.filter(one => one.id !== pin.id)}),
            },
            '×',
          ),
        );
      }),
    );
    byId('pins').hidden = pins.length === 0;
  }

  // ------------------------------------------------------------------------------------------------- Poincaré section

  private sectionPlace(): void {
    const field = byId<HTMLInputElement>('section-at'),
      first = this.store.state.equations?.coordinates[0]?.name;
    const {state} = this.store;
    byId('section').hidden = !first || betweenEnds(state) || !inTime(state) || (state.opened?.fields ?? false);
    // What was typed stays as long as it is about this model.
    const periods = state.equations?.sections ?? [];
    this.offerPeriods(periods);
    const offered = periods[0] ?? `${first} = 0`,
      typed = field.value !== this.offeredSection && field.value !== '',
      names = [...(state.equations?.coordinates ?? []), ...(state.equations?.parameters ?? [])],
      known = periods.includes(field.value) || names.some(one => field.value.includes(one.name));
    if (first && !(typed && known)) field.value = this.offeredSection = offered;
    this.showPeriod();
  }

  /** Where several frequencies drive the system, one has to be chosen. */
  private offerPeriods(periods: string[]): void {
    const choice = byId<HTMLSelectElement>('section-drive'),
      before = [...choice.options].map(option => option.value);
    byId('section-period').hidden = periods.length < 2;
    if (before.join() === ['', ...periods].join()) return;
    const drive = (at: string): string => at.replace(/ = 0.*/, '');
    choice.replaceChildren(
      h('option', {value: ''}, 'none'),
      ...periods.map(at => h('option', {value: at}, pretty(drive(at)))),
    );
  }

  /** The choice says what stands in the field. */
  private showPeriod(): void {
    const choice = byId<HTMLSelectElement>('section-drive'),
      at = byId<HTMLInputElement>('section-at').value.trim();
    choice.value = [...choice.options].some(option => option.value === at) ? at : '';
  }

  private sectionForm(): void {
    const field = byId<HTMLInputElement>('section-at');
    byId('section-drive').addEventListener('change', event => {
      const first = this.store.state.equations?.coordinates[0]?.name;
      field.value = (event.target as HTMLSelectElement).value || `${first} = 0`;
    });
    field.addEventListener('input', () => this.showPeriod());
    byId('section-form').addEventListener('submit', event => {
      event.preventDefault();
      const at = field.value.trim(),
        way = byId<HTMLSelectElement>('section-way').value;
      void this.study.searches.section(at + way, Number(byId<HTMLInputElement>('section-count').value) || 300);
    });
    byId('section-stop').addEventListener('click', () => this.study.asker.cancel('section'));
  }

  private section({section, sectionTrouble, sectionGone, busy}: State): void {
    byId('section-stop').hidden = busy !== 'section';
    const facts = section
      ? `${section.crossings} crossings${section.ended ? `; ${section.ended}` : ''}`
      : busy === 'section'
        ? 'It runs …'
        : sectionGone
          ? 'The section belonged to other values. Draw it anew.'
          : '';
    byId('section-body').replaceChildren(
      sectionTrouble ? troubleElement(sectionTrouble) : '',
      section ? h('div', {class: 'picture', html: section.svg}) : '',
      h('p', {class: 'muted'}, numbers(facts)),
    );
  }
}

const names: Record<string, string> = {
  reaction: 'forces of constraint',
  weight: 'weights',
  spring: 'springs',
  damper: 'dampers',
  applied: 'applied forces',
  potential: 'forces of V',
  torque: 'torques',
};
const nameOf = (e: SceneElement): string =>
  e.impulse ? 'impulses' : (names[e.origin ?? ''] ?? 'reactions and contacts');

/** Metres of the longest arrow of a force, at any time. */
function lengthOfArrows(drawing: Scene): number {
  const d = drawing.dimension;
  let longest = 0;
  for (const e of drawing.elements) {
    if (e.kind !== 'arrow' || e.impulse || e.points !== 2) continue;
    for (let i = 0; i < e.positions.length; i += 2 * d) {
      const length = Math.hypot(...Array.from({length: d}, (_, k) => e.positions[i + d + k] - e.positions[i + k]));
      if (length > longest) longest = length;
    }
  }
  return longest;
}
