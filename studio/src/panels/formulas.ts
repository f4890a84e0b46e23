import type {Line, Section} from '../contract';
import {pretty} from './words';
import {copyText, h, prose} from '../dom';

/** A line of mathematics with its sentence before it and the rule that made it at its side. */
export function lineElement(line: Line): HTMLElement {
  const long = line.mathml.includes('class="formula long"');
  return h(
    'div',
    {class: line.rule ? 'line ruled' : 'line'},
    line.sentence && h('p', {class: 'sentence'}, ...prose(line.sentence)),
    line.mathml && h('div', {class: long ? 'mathematics long' : 'mathematics', html: line.mathml}),
    line.rule && h('p', {class: 'rule'}, line.rule),
  );
}

export function plainOf(line: Line): string {
  return [line.left?.plain, line.right?.plain].filter(Boolean).join(' = ');
}

export function latexOf(lines: Line[]): string {
  return lines
    .filter(line => line.left || line.right)
    .map(line => `\\[ ${[line.left?.latex, line.right?.latex].filter(Boolean).join(' = ')} \\]`)
    .join('\n');
}

export function copyButton(lines: () => Line[], say: (text: string) => void): HTMLElement {
  return h(
    'button',
    {
      type: 'button',
      class: 'quiet',
      onclick: async () => {
        const done = await copyText(latexOf(lines()));
        say(done ? 'Copied as LaTeX.' : 'The browser did not let the page copy.');
      },
    },
    'Copy LaTeX',
  );
}

export function sectionsElements(sections: Section[], say: (text: string) => void): HTMLElement[] {
  return sections.map(section => {
    const steps = section.lines.length;
    return h(
      'details',
      {},
      h(
        'summary',
        {},
        pretty(section.title),
        h('span', {class: 'muted'}, `${steps} ${steps === 1 ? 'line' : 'lines'}`),
      ),
      h(
        'div',
        {class: 'tools'},
        copyButton(() => section.lines, say),
      ),
      ...(section.notes ?? []).map(text => h('p', {class: 'note'}, ...prose(text))),
      ...section.lines.map(lineElement),
    );
  });
}
