import {channels} from './chart';

/**
 * Maps of fields come from the core in colours for white paper. On dark paper the lightness of each is turned round, so
 * that where nothing is the map is dark, and hue and chroma stay.
 */
export function paintMaps(host: ParentNode): void {
  const paper = channels(getComputedStyle(document.documentElement).getPropertyValue('--figure')),
    dark = Math.max(...paper) < 128;
  for (const part of host.querySelectorAll<SVGElement>('.maup-plot g[stroke="none"] > [fill^="#"]')) {
    const own = (part.dataset.own ??= part.getAttribute('fill')!);
    part.setAttribute('fill', dark ? turned(own, paper) : own);
  }
}

function turned(colour: string, paper: number[]): string {
  const own = channels(colour),
    shift = 255 - Math.max(...own) - Math.min(...own);
  const mixed = own.map((x, k) => Math.round(paper[k] + ((255 - paper[k]) * (x + shift)) / 255));
  return `#${mixed.map(x => x.toString(16).padStart(2, '0')).join('')}`;
}
