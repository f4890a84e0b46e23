// What is asked about each model, and when two answers are the same.
import {readFileSync, readdirSync} from 'node:fs';
import {fileURLToPath} from 'node:url';

export const project = fileURLToPath(new URL('../..', import.meta.url));

/** The gallery with its folders: "pendulum.lag", "fields/maxwell.lag". */
export function models(only = '') {
  const found = readdirSync(project + 'models', {withFileTypes: true}).flatMap(entry =>
    entry.isDirectory()
      ? readdirSync(`${project}models/${entry.name}`).map(name => `${entry.name}/${name}`)
      : [entry.name],
  );
  return found.filter(name => name.endsWith('.lag') && name.includes(only)).sort();
}

const budget = 600;

/** Of the gallery: each line that expects something, the equations with their derivation, and the run. */
export function requestsFor(model) {
  return [
    {do: 'open', name: model, text: readFileSync(`${project}models/${model}`, 'utf8')},
    {do: 'expectations', budget},
    {do: 'equations', steps: true, budget},
    {do: 'run', frames: 12_000, errors: true, budget},
  ];
}

/** Numbers that come from arithmetic, not from the text: compared as numbers, to this part of their size. */
const close = (a, b, part, size = Math.max(Math.abs(a), Math.abs(b))) =>
  a === b || Math.abs(a - b) <= part * size + 1e-14;

const number = /[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?/g;

/** Two texts whose words are the same and whose numbers agree. */
function sameText(a, b, part) {
  if (a === b) return true;
  if (a.replace(number, '#') !== b.replace(number, '#')) return false;
  const left = a.match(number) ?? [],
    right = b.match(number) ?? [];
  return left.every((n, i) => close(Number(n), Number(right[i]), part));
}

// A drift and a residual are rounding errors themselves.
const roundings = new Set(['drift', 'residual', 'statistics']);

function* differences(a, b, path, part) {
  if (typeof a === 'string' && typeof b === 'string') {
    if (!sameText(a, b, part)) yield `${path}: ${a.slice(0, 200)} | ${b.slice(0, 200)}`;
  } else if (typeof a === 'number' && typeof b === 'number') {
    if (!close(a, b, part)) yield `${path}: ${a} | ${b}`;
  } else if (a !== null && b !== null && typeof a === 'object' && typeof b === 'object') {
    for (const key of new Set([...Object.keys(a), ...Object.keys(b)]))
      if (!roundings.has(key)) yield* differences(a[key], b[key], `${path}.${key}`, part);
  } else if (a !== b) {
    yield `${path}: ${JSON.stringify(a)} | ${JSON.stringify(b)}`;
  }
}

// Sums that cancel (a conserved quantity that is zero) are rounding errors of numbers of the size 1.
const noise = 1e-5;

/** A motion agrees as far as its own error estimates vouch for it: before that time, each column to a part of its size. */
function* runDifferences(a, b) {
  // An impact is a row twice, before and after, where its time is no time of the output: rounding decides on that.
  const [left, right] = [a, b].map(run => new Map(run.times.map((t, row) => [t, row])));
  const rows = a.times.map((t, row) => [row, right.get(t)]).filter(([row, other]) => other !== undefined && left.get(a.times[row]) === row);
  if (rows.length < 0.9 * Math.max(a.times.length, b.times.length) || a.times.at(-1) !== b.times.at(-1))
    return yield `run: ${rows.length} rows have the same times, of ${a.times.length} | ${b.times.length}`;
  const certain = Math.min(a.uncertain?.from ?? Infinity, b.uncertain?.from ?? Infinity);
  // A field's values at all places are of one size: beside a wave it is nearly zero, and what is there is rounding.
  const quantity = column => a.columns[column].name.replace(/\(.*/, ''),
    sizes = new Map();
  for (const [column, values] of a.values.entries())
    sizes.set(quantity(column), values.reduce((size, x) => Math.max(size, Math.abs(x ?? 0)), sizes.get(quantity(column)) ?? 0));
  for (const [column, values] of a.values.entries()) {
    if (a.columns[column].name.endsWith('drift')) continue;
    const size = sizes.get(quantity(column));
    const differs = rows.find(
      ([row, other]) => a.times[row] < 0.5 * certain && !close(values[row], b.values[column][other], 1e-7, size + noise),
    );
    if (differs) {
      const [row, other] = differs;
      yield `run: ${a.columns[column].name} at ${a.times[row]}: ${values[row]} | ${b.values[column][other]}, size ${size}`;
    }
  }
}

/** Of these models lines are written with other signs and in another order, equal as formulas: docs/design/web_assembly.md. */
export const reordered = new Set(['ball_on_turntable.lag', 'heavy_top.lag', 'fields/loaded_bridge.lag']);

const words = text => (text.match(/[\p{L}\p{N}_.'\\]+/gu) ?? []).sort();

/** Lines with the same words, whatever their order and signs. */
function* otherWords(a, b, path) {
  if (typeof a === 'string' && typeof b === 'string') {
    if (!path.endsWith('mathml')) yield* differences(words(a), words(b), path, 1e-9);
  } else if (a !== null && b !== null && typeof a === 'object' && typeof b === 'object') {
    for (const key of new Set([...Object.keys(a), ...Object.keys(b)])) yield* otherWords(a[key], b[key], `${path}.${key}`);
  } else if (a !== b && typeof a !== 'number') {
    yield `${path}: ${JSON.stringify(a)} | ${JSON.stringify(b)}`;
  }
}

/** What is not the same in the two answers to a request about a model; empty if they agree. */
export function compare(model, request, native, wasm) {
  if (native.ok !== wasm.ok)
    return [`ok: ${native.ok} | ${wasm.ok}: ${JSON.stringify((native.ok ? wasm : native).trouble)}`];
  if (!native.ok) return [...differences(native.trouble, wasm.trouble, 'trouble', 0)];
  switch (request.do) {
    case 'expectations': {
      const values = answer => answer.results.map(result => (result.actual.startsWith('drift ') ? '' : result.actual));
      const failed = answer => answer.results.filter(result => !result.passed).map(result => result.text);
      return [
        ...differences(failed(native), failed(wasm), 'failed', 0),
        ...differences(values(native), values(wasm), 'actual', 1e-5),
      ];
    }
    case 'run':
      return [...runDifferences(native, wasm)];
    case 'equations':
      if (reordered.has(model)) return [...otherWords(native, wasm, request.do)];
    // otherwise word by word
    default:
      return [...differences(native, wasm, request.do, 1e-9)];
  }
}
