import {numbers} from './panels/words';

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | ((event: never) => void) | null | undefined>;

/** An element; attributes that are functions are listeners (`onclick`), `html` is markup of the core. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name.slice(2), value as unknown as EventListener);
    else if (name === 'html') element.innerHTML = String(value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(
    ...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false),
  );
  return element;
}

export const byId = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

/** Text with `code` in backquotes, and symbols with an index, h_E and j^t, as a book sets them. */
export function prose(text: string): Node[] {
  return text.split('`').flatMap((part, i) => (i % 2 ? [h('code', {}, part)] : symbols(numbers(part))));
}

function symbols(text: string): Node[] {
  return text
    .replace(/(?<=(?<!\p{L})\p{L}\d*|\p{Script=Greek}\p{L}*)('{1,2})(?![\p{L}'])/gu, marks => '′″'[marks.length - 1])
    .split(/(?<![\p{L}\p{N}_^])([\p{L}∂][_^][\p{L}\p{N}])(?![\p{L}\p{N}_^])/u)
    .flatMap((part, i): Node[] => {
      if (i % 2) return [h('i', {}, part[0]), h(part[1] === '_' ? 'sub' : 'sup', {}, part[2])];
      return part ? [document.createTextNode(part)] : [];
    });
}

export function icon(path: string): SVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const shape = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  shape.setAttribute('d', path);
  svg.append(shape);
  return svg;
}

export function download(name: string, type: string, content: BlobPart): void {
  const address = URL.createObjectURL(new Blob([content], {type}));
  h('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = h('textarea', {readonly: true, class: 'away'}, text);
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}
