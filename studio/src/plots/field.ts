import type {Clock} from '../clock';
import type {RunAnswer} from '../contract';
import {h} from '../dom';
import {pretty, unitText} from '../panels/words';
import {channels, Chart, extent} from './chart';

/**
 * A field in motion: its values over the line it lives on, or as a map of the plane, at the moment that the clock
 * shows.
 */
export interface MovingField {
  element: HTMLElement;
  present(s: number): void;
  recolour(): void;
}

export function movingFields(run: RunAnswer, clock: Clock): MovingField[] {
  const {places = [], upwards = [], fields = []} = run;
  if (places.length < 2) return [];
  const size = places.length * Math.max(1, upwards.length);
  return fields.flatMap(field => {
    const columns = run.columns.flatMap((column, i) => (column.name.startsWith(`${field.name}(`) ? [i] : []));
    const rates = run.columns.flatMap((column, i) => (column.name.startsWith(`${field.name}'(`) ? [i] : []));
    if (columns.length !== size) return [];
    const values = new Moments(run, columns, rates.length === size ? rates : [], clock);
    const moving =
      upwards.length > 1
        ? map(values, places.length, upwards.length)
        : profile(values, places, withUnit(field.name, field.unit));
    moving.element.append(h('figcaption', {}, `${pretty(field.name)} in motion`));
    return [moving];
  });
}

const withUnit = (name: string, unit: string): string =>
  unit && unit !== '1' ? `${pretty(name)} (${unitText(unit)})` : pretty(name);

/** Values between the rows of the run, by their rates at both ends where these are known. */
class Moments {
  readonly range: [number, number];

  constructor(
    private readonly run: RunAnswer,
    private readonly columns: number[],
    private readonly rates: number[],
    private readonly clock: Clock,
  ) {
    this.range = extent(
      columns.map(c => ({x: [], y: run.values[c], series: 0, label: ''})),
      'y',
    );
  }

  at(s: number): number[] {
    const {times, values} = this.run,
      {way} = this.clock,
      last = times.length - 1;
    let row = 0;
    while (row < last - 1 && way * (times[row + 1] - times[0]) <= s) ++row;
    const step = last > 0 ? times[row + 1] - times[row] : 0,
      u = step ? Math.min(1, Math.max(0, (s - way * (times[row] - times[0])) / Math.abs(step))) : 0,
      w = 1 - u;
    return this.columns.map((column, i) => {
      const p = values[column][row] ?? NaN,
        q = last > 0 ? (values[column][row + 1] ?? NaN) : p;
      if (this.rates.length === 0 || u === 0) return p + u * (q - p);
      const a = (values[this.rates[i]][row] ?? NaN) * step,
        b = (values[this.rates[i]][row + 1] ?? NaN) * step;
      return p * (1 + 2 * u) * w * w + q * (3 - 2 * u) * u * u + a * u * w * w - b * u * u * w;
    });
  }
}

function profile(values: Moments, places: number[], up: string): MovingField {
  const canvas = h('canvas', {role: 'img', 'aria-label': `${up} over the line, at the moment that is shown`}),
    chart = new Chart(canvas, null);
  const present = (s: number): void =>
    chart.set({
      curves: [{x: places, y: values.at(s), series: 0, label: up}],
      x: 'x',
      y: up,
      overTime: false,
      moves: true,
      up: values.range,
    });
  return {element: h('figure', {class: 'chart field'}, canvas), present, recolour: () => chart.paintStill()};
}

/** Blue below the middle of the range, red above, paper between. */
function map(values: Moments, across: number, upwards: number): MovingField {
  const canvas = h('canvas', {
      role: 'img',
      class: 'map',
      'aria-label': 'The field as a map, at the moment that is shown',
    }),
    small = h('canvas', {width: across, height: upwards});
  let last = 0;
  const most = Math.max(Math.abs(values.range[0]), Math.abs(values.range[1])) || 1;
  const colour = (name: string): number[] => channels(getComputedStyle(canvas).getPropertyValue(name));
  const present = (s: number): void => {
    last = s;
    const box = canvas.getBoundingClientRect(),
      ratio = window.devicePixelRatio || 1;
    if (box.width === 0) return;
    const paper = colour('--figure'),
      ends = [colour('--series-1'), colour('--series-2')],
      now = values.at(s),
      context = small.getContext('2d')!,
      image = context.createImageData(across, upwards);
    for (let j = 0; j < upwards; ++j)
      for (let i = 0; i < across; ++i) {
        const x = now[j * across + i] / most,
          end = ends[x < 0 ? 0 : 1],
          part = Math.min(1, Math.abs(x)),
          at = 4 * ((upwards - 1 - j) * across + i);
        for (let k = 0; k < 3; ++k) image.data[at + k] = paper[k] + part * (end[k] - paper[k]);
        image.data[at + 3] = Number.isFinite(x) ? 255 : 0;
      }
    context.putImageData(image, 0, 0);
    canvas.width = Math.round(box.width * ratio);
    canvas.height = Math.round(box.height * ratio);
    const scale = Math.min(canvas.width / across, canvas.height / upwards),
      whole = canvas.getContext('2d')!;
    whole.imageSmoothingQuality = 'high';
    whole.drawImage(
      small,
      (canvas.width - scale * across) / 2,
      (canvas.height - scale * upwards) / 2,
      scale * across,
      scale * upwards,
    );
  };
  return {element: h('figure', {class: 'chart field'}, canvas), present, recolour: () => present(last)};
}
