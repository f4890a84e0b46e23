import type {Clock} from '../clock';
import type {RunAnswer} from '../contract';
import {byId, h} from '../dom';
import type {ChartSpec, Pin, State} from '../state';
import type {Store} from '../store';
import {nearestRow} from '../runs';
import {pretty, unitText} from '../panels/words';
import {movingFields, type MovingField} from './field';
import {Chart, type Curve} from './chart';

const withUnitOf = (name: string, unit: string): string =>
  unit && unit !== '1' ? `${pretty(name)} (${unitText(unit)})` : pretty(name);

const most = 5; // charts that a model gets unasked

/**
 * What a model asks for, else its coordinates; of one unit each; the phase portrait of the first coordinate next to
 * them.
 */
export function chartsOf(run: RunAnswer, state: State): ChartSpec[] {
  if (state.charts) return state.charts;
  if (run.places) return []; // a field is shown in motion
  const unitOf = (name: string): string | undefined => run.columns.find(column => column.name === name)?.unit;
  const exists = (name: string): boolean => unitOf(name) !== undefined;
  const coordinates = (state.equations?.coordinates ?? []).map(c => c.name).filter(exists);
  const plain = coordinates.length ? coordinates : run.columns.map(column => column.name);
  const asked = run.pictures.length ? run.pictures : [{columns: plain.slice(0, 8), against: ''}];
  const specs = asked.flatMap(({columns, against}) => {
    const groups = new Map<string, string[]>();
    for (const name of columns.filter(exists)) groups.set(unitOf(name)!, [...(groups.get(unitOf(name)!) ?? []), name]);
    return [...groups.values()].map((group): ChartSpec => ({
      columns: group,
      against: against && exists(against) ? against : null,
    }));
  });
  const first = coordinates[0];
  if (first && exists(`${first}'`) && !specs.some(spec => spec.against))
    specs.splice(1, 0, {columns: [`${first}'`], against: first});
  return specs.slice(0, most);
}

const uncertainIn = ({everything, columns}: NonNullable<RunAnswer['uncertain']>, shown: string[]): boolean =>
  everything || shown.some(name => columns.includes(name));

interface Shown {
  spec: ChartSpec;
  chart: Chart;
  caption: HTMLElement;
  canvas: HTMLCanvasElement;
}

/** Charts of the run, linked to the clock. */
export class PlotsPanel {
  private readonly host = byId('plots');
  private shown: Shown[] = [];
  private fields: MovingField[] = [];
  private of: RunAnswer | null = null; // the run that the fields are of

  constructor(
    private readonly store: Store<State>,
    private readonly clock: Clock,
  ) {
    clock.onTick(() => this.present());
    store.watch(['run', 'pins', 'charts', 'equations'], () => this.refresh());
  }

  recolour(): void {
    for (const {chart} of this.shown) chart.paintStill();
    for (const field of this.fields) field.recolour();
  }

  private refresh(): void {
    const {run} = this.store.state;
    if (!run) {
      this.shown = [];
      this.fields = [];
      return this.host.replaceChildren();
    }
    if (run !== this.of) {
      this.of = run;
      this.fields = movingFields(run, this.clock);
      this.host.querySelector('.moving')?.replaceChildren(...this.fields.map(one => one.element));
    }
    const specs = chartsOf(run, this.store.state),
      key = (list: ChartSpec[]): string => JSON.stringify(list);
    if (key(specs) !== key(this.shown.map(one => one.spec)) || this.host.childElementCount === 0)
      this.build(specs, run);
    else this.host.querySelector('.figures')?.replaceChildren(...this.figures(run));
    for (const one of this.shown) this.fill(one, run);
    if (!this.clock.playing) this.present();
  }

  private figures(run: RunAnswer): HTMLElement[] {
    return run.figures.map(({caption, svg}) =>
      h('figure', {class: 'given'}, h('div', {html: svg}), h('figcaption', {}, caption)),
    );
  }

  private build(specs: ChartSpec[], run: RunAnswer): void {
    this.shown = [];
    const figures = specs.map((spec, i) => {
      const canvas = h('canvas', {role: 'img'}),
        caption = h('figcaption', {});
      const chart = new Chart(canvas, time => {
        this.clock.play(false);
        this.clock.seek(this.clock.way * (time - this.clock.first));
      });
      this.shown.push({spec, chart, caption, canvas});
      const away = h(
        'button',
        {
          class: 'icon',
          type: 'button',
          'aria-label': 'Take this plot away',
          title: 'Take this plot away',
          onclick: () => this.store.update({charts: specs.filter((_, k) => k !== i)}),
        },
        '×',
      );
      return h(
        'figure',
        {class: spec.against ? 'chart phase' : 'chart'},
        canvas,
        h('div', {class: 'under'}, caption, away),
      );
    });
    this.host.replaceChildren(
      h('div', {class: 'moving'}, ...this.fields.map(one => one.element)),
      ...figures,
      h('div', {class: 'figures'}, ...this.figures(run)),
      run.columns.length <= 300 ? this.adder(specs, run) : '',
    );
  }

  private adder(specs: ChartSpec[], run: RunAnswer): HTMLElement {
    const option = (name: string): HTMLOptionElement => h('option', {value: name}, pretty(name));
    const across = h(
      'select',
      {'aria-label': 'Horizontal axis'},
      h('option', {value: ''}, pretty(run.independent.name)),
      ...run.columns.map(c => option(c.name)),
    );
    const up = h('select', {'aria-label': 'Vertical axis'}, ...run.columns.map(c => option(c.name)));
    return h(
      'form',
      {
        class: 'adder',
        onsubmit: (event: Event) => {
          event.preventDefault();
          this.store.update({charts: [...specs, {columns: [up.value], against: across.value || null}]});
        },
      },
      h('span', {}, 'Plot '),
      up,
      h('span', {}, ' over '),
      across,
      h('button', {type: 'submit'}, 'Add'),
      this.store.state.charts &&
        h('button', {type: 'button', onclick: () => this.store.update({charts: null})}, 'As the model asks'),
    );
  }

  private fill({spec, chart, caption, canvas}: Shown, run: RunAnswer): void {
    const pinned = this.store.state.pins.filter(pin => pin.shown),
      column = (of: RunAnswer, name: string) => of.columns.findIndex(c => c.name === name);
    const curves: Curve[] = [];
    for (const pin of pinned)
      for (const name of spec.columns) {
        const y = column(pin.run, name),
          x = spec.against ? column(pin.run, spec.against) : -1;
        if (y >= 0 && (!spec.against || x >= 0))
          curves.push({
            x: spec.against ? pin.run.values[x] : pin.run.times,
            y: pin.run.values[y],
            series: pin.series,
            label: pin.label,
            faint: true,
          });
      }
    spec.columns.forEach((name, i) => {
      const y = column(run, name),
        x = spec.against ? column(run, spec.against) : -1;
      if (y < 0 || (spec.against && x < 0)) return;
      curves.push({x: spec.against ? run.values[x] : run.times, y: run.values[y], series: i % 7, label: name});
    });
    const unit = run.columns.find(c => c.name === spec.columns[0])?.unit ?? '',
      acrossUnit = spec.against ? (run.columns.find(c => c.name === spec.against)?.unit ?? '') : run.independent.unit;
    const across = withUnitOf(spec.against ?? run.independent.name, acrossUnit);
    const up =
      spec.columns.length === 1 ? withUnitOf(spec.columns[0], unit) : unit && unit !== '1' ? `(${unitText(unit)})` : '';
    chart.set({
      curves,
      x: across,
      y: up,
      overTime: !spec.against,
      uncertain: run.uncertain && uncertainIn(run.uncertain, spec.columns) ? run.uncertain.from : null,
      marks: run.happenings.length <= 60 ? run.happenings.map(one => one.t) : [],
    });
    if (pinned.length > 0 || caption.childElementCount !== spec.columns.length) this.name(spec, pinned, caption);
    canvas.setAttribute(
      'aria-label',
      `${spec.columns.map(pretty).join(', ')} over ${pretty(spec.against ?? run.independent.name)}` +
        (pinned.length ? `, with ${pinned.length} pinned` : ''),
    );
  }

  private name(spec: ChartSpec, pinned: Pin[], caption: HTMLElement): void {
    const names = spec.columns.map((name, i) => {
      const symbol = this.symbolOf(name);
      return symbol
        ? h('span', {class: `key s${(i % 7) + 1}`, html: `<math><mrow>${symbol}</mrow></math>`})
        : h('span', {class: `key s${(i % 7) + 1}`}, pretty(name));
    });
    const ghosts = pinned.map(pin => h('span', {class: `key faint s${pin.series + 1}`}, pin.label));
    caption.replaceChildren(...names, ...ghosts);
  }

  /** A coordinate or its velocity as the equations have it. */
  private symbolOf(name: string): string | undefined {
    for (const c of this.store.state.equations?.coordinates ?? []) {
      if (c.name === name) return c.symbol?.mathml;
      if (`${c.name}'` === name) return c.velocity?.mathml;
    }
    return undefined;
  }

  private present(): void {
    const {run} = this.store.state;
    if (!run || run.times.length === 0) return;
    const row = nearestRow(run, this.clock.s);
    for (const {chart} of this.shown) chart.present(this.clock.now, row);
    for (const field of this.fields) field.present(this.clock.s);
  }
}
