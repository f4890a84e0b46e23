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
const close = (a, b, part, size = Math.max(Math.abs(a), Math.abs(b)), least = 1e-14) =>
  a === b || Math.abs(a - b) <= part * size + least;

const number = /[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?/g;

/** Two texts whose words are the same and whose numbers agree, to a part of their size or to `least`. */
function sameText(a, b, part, least = 1e-14) {
  if (a === b) return true;
  if (a.replace(number, '#') !== b.replace(number, '#')) return false;
  const left = a.match(number) ?? [],
    right = b.match(number) ?? [];
  return left.every((n, i) => close(Number(n), Number(right[i]), part, undefined, Math.max(least, 1e-14)));
}

/** Of values of runs so many digits agree. */
const digits = 1e-5;

/**
 * Of "± 1e-06 m", in the unit of the value; 0 where a line has none. A value that a line expects to be 0, as a wave
 * where it has a node, is what the errors of numbers of the size 1 leave, and has no size of its own: its line says by
 * its tolerance what counts, and five digits of that are compared, as of values five of theirs.
 */
const absoluteTolerance = text => Number(/^± ([-+.\deE]+)/.exec(text ?? '')?.[1] ?? 0) || 0;

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

/**
 * A motion agrees as far as its own error estimates vouch for it: before that time, each column to a part of its size.
 */
function* runDifferences(a, b) {
  // The time of an impact, and of an end that the motion finds itself, is right to rounding. An impact is a row twice,
  // before and after, and once where its time is one of the output: rounding decides on that.
  const same = (t, u) => Math.abs(t - u) <= 1e-9 * Math.abs(a.times.at(-1) - a.times[0]);
  const rows = [];
  for (let row = 0, other = 0; row < a.times.length && other < b.times.length; )
    if (same(a.times[row], b.times[other])) rows.push([row++, other++]);
    else if (Math.abs(a.times[row] - a.times[0]) < Math.abs(b.times[other] - a.times[0])) ++row;
    else ++other;
  if (rows.length < 0.9 * Math.max(a.times.length, b.times.length) || !same(a.times.at(-1), b.times.at(-1)))
    return yield `run: ${rows.length} rows have the same times, of ${a.times.length} | ${b.times.length}`;
  const certain = Math.min(a.uncertain?.from ?? Infinity, b.uncertain?.from ?? Infinity);
  // A field's values at all places are of one size: beside a wave it is nearly zero, and what is there is rounding.
  const quantity = column => a.columns[column].name.replace(/\([-\d., e]+\)$/, '(x)'),
    sizes = new Map();
  for (const [column, values] of a.values.entries())
    sizes.set(
      quantity(column),
      values.reduce((size, x) => Math.max(size, Math.abs(x ?? 0)), sizes.get(quantity(column)) ?? 0),
    );
  for (const [column, values] of a.values.entries()) {
    if (a.columns[column].name.endsWith('drift')) continue;
    const size = sizes.get(quantity(column));
    const differs = rows.find(
      ([row, other]) =>
        a.times[row] < 0.5 * certain && !close(values[row], b.values[column][other], 1e-7, size + noise),
    );
    if (differs) {
      const [row, other] = differs;
      const at = `${a.columns[column].name} at ${a.times[row]}`;
      yield `run: ${at}: ${values[row]} | ${b.values[column][other]}, size ${size}`;
    }
  }
}

/** Of these models lines are written with other signs and in another order: docs/design/web_assembly.md. */
export const reordered = new Set([
  'ball_on_turntable.lag',
  'heavy_top.lag',
  'snakeboard.lag',
  'fields/loaded_bridge.lag',
  'fields/moving_load.lag',
]);

/** A formula as it is printed, with a number for each name: "2 m R^2 (a' - b/3)", where w(L/2) is a name too. */
export function valueOf(text) {
  const tokens = text.match(/\d+(\.\d+)?|\p{L}[\p{L}\p{N}_.]*'*(\([^()]*\))?|[-+*/^()]|\S/gu) ?? [];
  const numberOf = name =>
    [...name].reduce((sum, sign, i) => (sum + (i + 7) * sign.codePointAt(0) * 0.6180339) % 1, 0.1) + 0.5;
  const take = sign => tokens[0] === sign && tokens.shift();
  const sum = () => {
    let value = take('-') ? -term() : term();
    while (/^[-+]$/.test(tokens[0])) value += tokens.shift() === '-' ? -term() : term();
    return value;
  };
  const term = () => {
    let value = power();
    while (tokens.length > 0 && !/^[-+)]$/.test(tokens[0]))
      value = take('/') ? value / power() : (take('*'), value * power());
    return value;
  };
  const power = () => {
    const base = atom();
    return take('^') ? base ** atom() : base;
  };
  const atom = () => {
    const token = tokens.shift() ?? '';
    if (token === '(') {
      const value = sum();
      return take(')') ? value : NaN;
    }
    return /^\d/.test(token) ? Number(token) : /^\p{L}/u.test(token) ? numberOf(token) : NaN;
  };
  const value = sum();
  return tokens.length === 0 ? value : NaN;
}

/** Formulas that are equal, however they are written; an equation … = 0 may be written with the other sign. */
function* otherFormulas(a, b, path, signed = true) {
  if (/\.(mathml|latex)$/.test(path) || a === b) return;
  if (path.endsWith('.plain')) {
    const [left, right] = [a, b].map(text => (signed ? valueOf(text) : Math.abs(valueOf(text))));
    if (!close(left, right, 1e-9)) yield `${path}: ${a} | ${b}`;
  } else if (a !== null && b !== null && typeof a === 'object' && typeof b === 'object') {
    const isZero = a.right?.plain === '0' && b.right?.plain === '0';
    for (const key of new Set([...Object.keys(a), ...Object.keys(b)]))
      yield* otherFormulas(a[key], b[key], `${path}.${key}`, signed && !isZero);
  } else {
    yield* differences(a, b, path, 1e-9);
  }
}

/** What is not the same in the two answers to a request about a model; empty if they agree. */
export function compare(model, request, native, wasm) {
  if (native.ok !== wasm.ok)
    return [`ok: ${native.ok} | ${wasm.ok}: ${JSON.stringify((native.ok ? wasm : native).trouble)}`];
  if (!native.ok) return [...differences(native.trouble, wasm.trouble, 'trouble', 0)];
  switch (request.do) {
    case 'expectations': {
      // The drift of what is conserved is rounding.
      const values = answer => answer.results.map(result => (/ conserved/.test(result.text) ? '' : result.actual));
      const failed = answer => answer.results.filter(result => !result.passed).map(result => result.text);
      const [here, there] = [values(native), values(wasm)];
      return [
        ...differences(failed(native), failed(wasm), 'failed', 0),
        ...differences(here.length, there.length, 'lines', 0),
        ...here.flatMap((actual, i) =>
          sameText(actual, there[i], digits, digits * absoluteTolerance(native.results[i].tolerance))
            ? []
            : [`actual.${i}: ${actual} | ${there[i]}`],
        ),
      ];
    }
    case 'run':
      return [...runDifferences(native, wasm)];
    case 'equations':
      if (reordered.has(model)) return [...otherFormulas(native, wasm, request.do)];
    // otherwise word by word
    default:
      return [...differences(native, wasm, request.do, 1e-9)];
  }
}
