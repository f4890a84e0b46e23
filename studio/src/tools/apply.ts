import type {Edit} from '../contract';

/** The text without what stands in comments and strings; offsets stay. */
function bare(text: string): string {
  return text.replace(/"[^"\n]*"|#[^\n]*/g, part => ' '.repeat(part.length));
}

interface Assignment {
  name: string;
  from: number;
  to: number;
}

/** The values of all `param` or `start` statements: where each stands. */
export function assignments(text: string, word: 'param' | 'start'): Assignment[] {
  const out: Assignment[] = [],
    plain = bare(text);
  for (const statement of plain.matchAll(new RegExp(`^${word}\\b([^\\n]*(?:\\n[ \\t]+[^\\n]*)*)`, 'gm'))) {
    let at = statement.index + word.length,
      depth = 0,
      begin = at;
    const take = (end: number): void => {
      // Before the name may stand `exactly`, and a time: `start at 2 s θ = 1`.
      const found = /^[^=]*?([^\s=,()]+)\s*=\s*/.exec(plain.slice(begin, end));
      if (found) {
        const from = begin + found[0].length,
          value = plain.slice(from, end);
        out.push({name: found[1], from, to: from + value.trimEnd().length});
      }
      begin = end + 1;
    };
    const stop = statement.index + statement[0].length;
    for (; at < stop; ++at) {
      if (plain[at] === '(') ++depth;
      else if (plain[at] === ')') --depth;
      else if (plain[at] === ',' && depth === 0) take(at);
    }
    take(stop);
  }
  return out;
}

/**
 * Edits that write these values into the text; start values that have no place yet come behind the last `start`, or at
 * the end of the declarations.
 */
export function applied(
  text: string,
  set: Record<string, string>,
  start: Record<string, string>,
): {edits: Edit[]; missing: string[]} {
  const edits: Edit[] = [],
    missing: string[] = [],
    parameters = assignments(text, 'param'),
    starts = assignments(text, 'start');
  for (const [name, value] of Object.entries(set)) {
    const place = parameters.filter(one => one.name === name).pop();
    if (place) edits.push({from: place.from, to: place.to, insert: inUnitOf(text.slice(place.from, place.to), value)});
    else missing.push(name);
  }
  const added: string[] = [];
  for (const [name, value] of Object.entries(start)) {
    const place = starts.filter(one => one.name === name).pop();
    if (place) edits.push({from: place.from, to: place.to, insert: inUnitOf(text.slice(place.from, place.to), value)});
    else added.push(`${name} = ${value}`);
  }
  if (added.length > 0) {
    const last = starts.reduce((end, one) => Math.max(end, one.to), -1);
    if (last >= 0) addTo(edits, last, `, ${added.join(', ')}`);
    else {
      const at = placeOfStart(text);
      edits.push({from: at, to: at, insert: `start ${added.join(', ')}\n`});
    }
  }
  return {edits: edits.sort((a, b) => a.from - b.from || a.to - b.to), missing};
}

/** An edit may end where this one begins: it becomes part of it. */
function addTo(edits: Edit[], at: number, insert: string): void {
  const before = edits.find(edit => edit.to === at);
  if (before) before.insert += insert;
  else edits.push({from: at, to: at, insert});
}

const inSi: Record<string, [string, number]> = {
  deg: ['rad', Math.PI / 180],
  'deg/s': ['rad/s', Math.PI / 180],
  cm: ['m', 0.01],
  mm: ['m', 0.001],
  km: ['m', 1000],
  'cm/s': ['m/s', 0.01],
  'km/h': ['m/s', 1 / 3.6],
};

/** The value in the unit that the text has there: 1.8 rad, where 120 deg stood, is 103.13… deg. */
function inUnitOf(written: string, value: string): string {
  const unit = /^[-+\d.e]+\s*(\S.*)$/.exec(written)?.[1] ?? '',
    [si, factor] = inSi[unit] ?? [],
    [, number, own] = /^(\S+) (.+)$/.exec(value) ?? [];
  return factor && own === si ? `${Number((Number(number) / factor).toPrecision(10))} ${unit}` : value;
}

/** Before the line of `run`, else before what is drawn or expected, else at the end. */
function placeOfStart(text: string): number {
  const found = /^(run|draw|plot|output|expect)\b/m.exec(bare(text));
  return found ? found.index : text.length;
}
