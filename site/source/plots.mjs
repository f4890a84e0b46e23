// Plots of the tables of docs/benchmarks.md, drawn from the numbers that stand there.
import {escape} from './highlight.mjs';

const exact = value => Number(value.toPrecision(6));
const prefix = {n: 1e-9, µ: 1e-6, μ: 1e-6, m: 1e-3, '': 1};

/// "3.36 µs" → 3.36e-6; null where it is no time.
export function seconds(text) {
  const match = text.trim().match(/^([\d.,]+(?:e[+-]?\d+)?) ?(n|µ|μ|m|)s\b/);
  return match ? exact(Number(match[1].replaceAll(',', '')) * prefix[match[2]]) : null;
}

/// [{header, rows}] of a Markdown text.
export function tables(text) {
  const found = [];
  let table = null;
  for (const line of text.split('\n')) {
    if (!line.startsWith('|')) {
      table = null;
      continue;
    }
    const cells = line
      .split(/(?<!\\)\|/)
      .slice(1, -1)
      .map(cell => cell.trim());
    if (!table) found.push((table = {header: cells, rows: []}));
    else if (!cells.every(cell => /^:?-+:?$/.test(cell))) table.rows.push(cells);
  }
  return found;
}

const need = (what, found) => {
  if (!found?.length) throw new Error(`docs/benchmarks.md has no rows for the plot of ${what}`);
  return found;
};

/// The plots by the name of the picture that they take the place of: {title, x, y, series: [{name, points}]}.
export function benchmarkPlots(text) {
  const all = tables(text),
    rows = all.flatMap(table => table.rows);
  const links = (pattern, column = 1) =>
    rows
      .map(row => [row[0].match(pattern), row])
      .filter(([m]) => m)
      .map(([m, row]) => [Number(m[1]), seconds(row[column])])
      .filter(([, y]) => y !== null);
  const peers = all.find(table => /error of the energy/.test(table.header[1] ?? '')),
    methods = new Map();
  for (const [what, error, time] of peers?.rows ?? []) {
    const name = what.split(',')[0].replaceAll('_', ' ');
    if (!methods.has(name)) methods.set(name, []);
    methods.get(name).push([Number(error), seconds(time)]);
  }
  const dynamics = all.find(table => /MuJoCo/.test(table.header[3] ?? ''));
  const column = k => (dynamics?.rows ?? []).map(row => [Number(row[0].replace('n=', '')), seconds(row[k])]);
  return {
    step_cost: {
      title: 'A step of order 20 against the number of links',
      x: 'links',
      y: 'time of a step',
      series: [
        {name: 'machine code', points: need('steps', links(/^n=(\d+), a step$/))},
        {name: 'interpreter', points: need('steps', links(/^n=(\d+), a step by the interpreter alone$/))},
      ],
    },
    work_precision: {
      title: 'Time for a second of motion against the error of the energy after 100 s',
      x: 'error of the energy',
      y: 'a second of motion',
      reverse: true,
      series: need(
        'accuracy',
        [...methods].map(([name, points]) => ({name, points})),
      ),
    },
    forward_dynamics: {
      title: 'Accelerations of a chain against the number of links',
      x: 'links',
      y: 'time of an evaluation',
      series: [
        {name: 'compiled', points: need('accelerations', column(1))},
        {name: 'interpreted', points: column(2)},
        {name: 'MuJoCo', points: column(3)},
      ],
    },
  };
}

// ------------------------------------------------------------------------------------------------------- drawing

const power = k => `10${String(k).replace(/./g, c => ({'-': '⁻'})[c] ?? '⁰¹²³⁴⁵⁶⁷⁸⁹'[c])}`;
const timeText = k =>
  [
    [-9, 'ns'],
    [-6, 'µs'],
    [-3, 'ms'],
    [0, 's'],
  ]
    .map(([e, unit]) => [k - e, unit])
    .filter(([d]) => d >= 0 && d < 3)
    .map(([d, unit]) => `${10 ** d} ${unit}`)[0] ?? power(k);

/// Both axes are logarithmic. Names stand at the ends of the curves; colours and marks are those of the page.
export function logPlot({title, x, y, series, reverse}) {
  const width = 680,
    height = 400,
    left = 78,
    right = 150,
    top = 18,
    bottom = 56,
    log = Math.log10;
  const xs = series.flatMap(s => s.points.map(p => log(p[0]))),
    ys = series.flatMap(s => s.points.map(p => log(p[1])));
  const small = Math.max(...xs) - Math.min(...xs) < 3;
  const [x0, x1] = small
    ? [Math.min(...xs) - 0.08, Math.max(...xs) + 0.08]
    : [Math.floor(Math.min(...xs)), Math.ceil(Math.max(...xs))];
  const [y0, y1] = [Math.floor(Math.min(...ys)), Math.ceil(Math.max(...ys))];
  const across = v => left + ((reverse ? x1 - v : v - x0) / (x1 - x0)) * (width - left - right),
    up = v => height - bottom - ((v - y0) / (y1 - y0)) * (height - top - bottom);
  const f = v => v.toFixed(1);
  let svg = '';
  const every = Math.ceil((x1 - x0) / 7);
  const ticks = small
    ? [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].map(v => [log(v), String(v)]).filter(([v]) => v >= x0 && v <= x1)
    : Array.from({length: x1 - x0 + 1}, (_, i) => x0 + i)
        .filter(k => k % every === 0)
        .map(k => [k, power(k)]);
  for (const [v, text] of ticks)
    svg += `<path class="grid" d="M${f(across(v))} ${top}V${height - bottom}"/>
<text class="tick" x="${f(across(v))}" y="${height - bottom + 20}" text-anchor="middle">${text}</text>\n`;
  for (let k = y0; k <= y1; ++k)
    svg += `<path class="grid" d="M${left} ${f(up(k))}H${width - right}"/>
<text class="tick" x="${left - 8}" y="${f(up(k) + 4)}" text-anchor="end">${timeText(k)}</text>\n`;
  svg += `<path class="axis" d="M${left} ${top}V${height - bottom}H${width - right}"/>
<text x="${(left + width - right) / 2}" y="${height - 12}" text-anchor="middle">${escape(x)}</text>
<text transform="translate(16 ${(top + height - bottom) / 2}) rotate(-90)"
 text-anchor="middle">${escape(y)}</text>\n`;
  const ends = series
    .map((s, i) => ({i, s, last: [...s.points].sort((a, b) => (reverse ? b[0] - a[0] : a[0] - b[0])).at(-1)}))
    .map(e => ({...e, x: across(log(e.last[0])), y: up(log(e.last[1])), label: 0}));
  let previous = -Infinity;
  for (const end of [...ends].sort((a, b) => a.y - b.y)) previous = end.label = Math.max(end.y, previous + 17);
  for (const {i, s, x: ex, y: ey, label} of ends) {
    const points = [...s.points].sort((a, b) => a[0] - b[0]).map(p => [across(log(p[0])), up(log(p[1]))]);
    const marks = points.map(p => `<circle cx="${f(p[0])}" cy="${f(p[1])}" r="3.2"/>`).join('');
    svg += `<g class="s${i + 1}"><path class="curve" d="M${points.map(p => p.map(f).join(' ')).join('L')}"/>${marks}`;
    const at = Math.max(ex + 10, width - right + 8);
    svg += `<path class="leader" d="M${f(ex + 5)} ${f(ey)}L${f(at - 2)} ${f(label)}"/>
<text x="${f(at)}" y="${f(label + 4)}">${escape(s.name)}</text></g>\n`;
  }
  return `<figure class="plot"><div class="scroll">
<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="${escape(title)}">
${svg}</svg></div>
<figcaption>${escape(title)}, from the table.</figcaption></figure>`;
}
