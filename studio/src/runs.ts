import type {RunAnswer} from './contract';

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

export const withUnit = (value: number, unit: string): string =>
  `${Number(value.toPrecision(12))}${unit ? ' ' + unit : ''}`;
export const short = (value: string): string =>
  value.replace(/-?\d+\.\d{4,}/, number => String(Number(Number(number).toPrecision(4))));
