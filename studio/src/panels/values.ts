import type {Coordinate, Formula, Parameter} from '../contract';
import {byId, h} from '../dom';
import {betweenEnds, inTime, type State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {unitText} from './words';
import {rangeOfParameter, rangeOfStart, shown, widened, type Range} from './range';

interface Row {
  element: HTMLElement;
  slider: HTMLInputElement;
  field: HTMLInputElement;
  reset: HTMLButtonElement;
  range: Range;
  show(value: number | null, changed: boolean): void;
}

/** A name with its slider, number, unit and the way back to what the text says. */
function makeRow(
  name: string,
  symbol: Formula | null,
  unit: string,
  range: Range,
  change: (value: number, resting: boolean) => void,
  back: () => void,
): Row {
  const slider = h('input', {
    type: 'range',
    min: range.low,
    max: range.high,
    step: range.step,
    'aria-label': `${name}${unit ? ` in ${unit}` : ''}`,
  });
  const field = h('input', {type: 'number', step: 'any', 'aria-label': `${name}: number${unit ? ` in ${unit}` : ''}`});
  const reset = h(
    'button',
    {type: 'button', class: 'icon', 'aria-label': `${name} as in the text`, title: 'As in the text', onclick: back},
    '↺',
  );
  const label = h('span', {class: 'symbol', html: symbol ? `<math><mrow>${symbol.mathml}</mrow></math>` : ''});
  if (!symbol) label.textContent = name;
  const element = h(
    'div',
    {class: 'value', 'data-name': name},
    label,
    slider,
    field,
    h('span', {class: 'unit'}, unitText(unit)),
    reset,
  );
  let placed: number | null = null; // where the slider was put last
  const row: Row = {
    element,
    slider,
    field,
    reset,
    range,
    show(value, changed) {
      element.classList.toggle('changed', changed);
      reset.disabled = !changed;
      if (value === null) {
        field.value = '';
        return;
      }
      const range = widened(row.range, value);
      if (range !== row.range) {
        row.range = range;
        [slider.min, slider.max, slider.step] = [String(range.low), String(range.high), String(range.step)];
      }
      // Only what changes is written: a row costs layout, and there may be many.
      if (document.activeElement !== field && field.value !== shown(value)) field.value = shown(value);
      if (value === placed) return;
      if (document.activeElement !== slider || Math.abs(Number(slider.value) - value) > row.range.step) {
        slider.value = String(value);
        placed = value;
      }
    },
  };
  slider.addEventListener('input', () => {
    placed = null;
    field.value = shown(Number(slider.value));
    change(Number(slider.value), false);
  });
  slider.addEventListener('change', () => change(Number(slider.value), true));
  field.addEventListener('change', () => {
    const value = Number(field.value);
    if (field.value !== '' && Number.isFinite(value)) change(value, true);
  });
  return row;
}

const degrees = 180 / Math.PI;
/** Angles are told in degrees; the contract has rad. */
const inDegrees = (c: Coordinate): boolean => c.unit === 'rad' || c.kind === 'angle';

/** Every parameter and every start value as a slider. */
export class ValuesPanel {
  private readonly parameters = byId('parameters');
  private readonly starts = byId('starts');
  private rows = new Map<string, Row>();
  private shape = '';

  constructor(
    private readonly store: Store<State>,
    private readonly study: Study,
  ) {
    store.watch(['equations', 'run', 'runTrouble', 'answered', 'set', 'start', 'mode', 'duration'], () =>
      this.refresh(),
    );
  }

  private refresh(): void {
    const {equations} = this.store.state;
    byId('values').classList.toggle('empty', !equations);
    if (!equations) {
      this.shape = '';
      this.parameters.replaceChildren();
      this.starts.replaceChildren();
      this.rows.clear();
      return;
    }
    const parameters = equations.parameters.filter(p => p.used && p.value !== null);
    const shape = JSON.stringify([
      equations.name,
      parameters.map(p => [p.name, p.unit]),
      equations.coordinates.map(c => [c.name, c.unit]),
    ]);
    if (shape !== this.shape) this.build(parameters, equations.coordinates, shape);
    for (const p of parameters) this.showParameter(p);
    for (const c of equations.coordinates) this.showStart(c);
    const still = betweenEnds(this.store.state);
    byId('start-group').hidden = equations.coordinates.length === 0 || still;
    byId('run-group').hidden = still && !inTime(this.store.state);
    const {set, start, mode, duration} = this.store.state,
      changed = Object.keys(set).length + Object.keys(start).length > 0;
    byId<HTMLButtonElement>('apply-values').disabled = !changed;
    byId<HTMLButtonElement>('reset-values').disabled = !(changed || mode || duration);
  }

  private build(parameters: Parameter[], coordinates: Coordinate[], shape: string): void {
    this.shape = shape;
    this.rows.clear();
    this.parameters.replaceChildren(...parameters.map(p => this.parameterRow(p)));
    this.starts.replaceChildren(...coordinates.flatMap(c => [this.startRow(c, 0), this.startRow(c, 1)]));
    byId('no-parameters').hidden = parameters.length > 0;
  }

  private parameterRow(p: Parameter): HTMLElement {
    const row = makeRow(
      p.name,
      p.symbol,
      p.unit,
      rangeOfParameter(p.value!),
      (value, resting) => this.study.setValue(p.name, `${shown(value)}${p.unit ? ' ' + p.unit : ''}`, resting),
      () => this.study.setValue(p.name, null, true),
    );
    this.rows.set(p.name, row);
    return row.element;
  }

  private startRow(c: Coordinate, order: 0 | 1): HTMLElement {
    const name = order ? c.name + "'" : c.name,
      angle = inDegrees(c) && order === 0,
      unit = angle ? 'deg' : order ? c.velocity_unit : c.unit;
    const now = (order ? c.v : c.q) ?? 0,
      radius = this.store.state.run?.drawing?.radius ?? 1,
      scale = inDegrees(c) ? (order ? 10 : 180) : radius;
    const row = makeRow(
      name,
      order ? c.velocity : c.symbol,
      unit,
      rangeOfStart(angle ? now * degrees : now, unit, scale),
      (value, resting) => this.study.setStart(name, `${shown(value)}${unit ? ' ' + unit : ''}`, resting),
      () => this.study.setStart(name, null, true),
    );
    this.rows.set(name, row);
    return row.element;
  }

  private showParameter(p: Parameter): void {
    const override = this.store.state.set[p.name];
    this.rows.get(p.name)?.show(override !== undefined ? Number.parseFloat(override) : p.value, override !== undefined);
  }

  private showStart(c: Coordinate): void {
    const {run, runTrouble, answered, start} = this.store.state;
    for (const order of [0, 1]) {
      const name = order ? c.name + "'" : c.name,
        override = start[name],
        met = run && !runTrouble ? run.start[name] : undefined;
      const si = met ?? (order ? c.v : c.q),
        factor = inDegrees(c) && order === 0 ? degrees : 1;
      const own =
        override?.endsWith('deg') && order === 0
          ? Number.parseFloat(override)
          : override !== undefined
            ? Number.parseFloat(override) * factor
            : null;
      // What the run met, where constraints moved it, is that of the values when it has come.
      const asked = own !== null && (!answered || runTrouble !== null || si === null);
      this.rows.get(name)?.show(asked ? own : si === null ? null : si * factor, override !== undefined);
    }
  }
}
