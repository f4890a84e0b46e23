import type {Line, Section} from '../contract';
import {pretty} from './words';
import {copyText, h, prose} from '../dom';

/** By how much mathematics is wider than its place. */
export function excess(element: HTMLElement): number {
  const parts = [element, ...element.querySelectorAll<HTMLElement>('.mathematics, .formula')];
  return Math.max(...parts.map(one => one.scrollWidth / (one.clientWidth || Infinity)));
}

/** Sets mathematics smaller where a piece that cannot be broken is wider than its place: nothing of it is cut off. */
export function fit(element: HTMLElement, least: number): void {
  const over = excess(element);
  if (over > 1.001) element.style.fontSize = `${Math.max(least, (0.985 / over) * sizeOf(element))}em`;
}
const sizeOf = (element: HTMLElement): number => parseFloat(element.style.fontSize) || 1;

/** The equations of motion have one size. */
function asOne(element: HTMLElement): void {
  const all = [...(element.closest('.numbered')?.querySelectorAll<HTMLElement>('.mathematics') ?? [])],
    least = Math.min(...all.map(sizeOf));
  if (least < 1) for (const one of all) one.style.fontSize = `${least}em`;
}

/** Lines out of sight have no size yet; each is fitted as it comes into sight, and anew when the window changes. */
const coming = new IntersectionObserver(entries => {
  const lines = entries.filter(one => one.isIntersecting).map(one => one.target as HTMLElement);
  for (const line of lines) fit(line, 0.6);
  for (const line of lines) asOne(line);
});
addEventListener('resize', () => {
  for (const one of document.querySelectorAll<HTMLElement>('.mathematics')) {
    one.style.fontSize = '';
    coming.unobserve(one);
    coming.observe(one);
  }
});

/** A line of mathematics with its sentence before it and the rule that made it at its side. */
export function lineElement(line: Line): HTMLElement {
  const long = line.mathml.includes('class="formula long"');
  const mathematics = line.mathml && h('div', {class: long ? 'mathematics long' : 'mathematics', html: line.mathml});
  if (mathematics) coming.observe(mathematics);
  return h(
    'div',
    {class: line.rule ? 'line ruled' : 'line'},
    line.sentence && h('p', {class: 'sentence'}, ...prose(line.sentence)),
    mathematics,
    line.rule && h('p', {class: 'rule'}, ...prose(line.rule)),
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
        h('span', {}, ...prose(pretty(section.title))),
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
