import {byId} from '../dom';
import type {Storage_} from './storage';

/**
 * Light or dark as the system has it, until the user chooses; paper is always light, and everything on it is unfolded.
 */
export function themes(storage: Storage_, recolour: () => void): void {
  const root = document.documentElement,
    system = matchMedia('(prefers-color-scheme: dark)'),
    kept = storage.setting('theme');
  if (kept === 'light' || kept === 'dark') root.dataset.theme = kept;
  const dark = (): boolean => (root.dataset.theme ? root.dataset.theme === 'dark' : system.matches);
  byId('theme-button').addEventListener('click', () => {
    const next = dark() ? 'light' : 'dark';
    if ((next === 'dark') === system.matches) {
      delete root.dataset.theme;
      storage.setSetting('theme', '');
    } else {
      root.dataset.theme = next;
      storage.setSetting('theme', next);
    }
    recolour();
  });
  system.addEventListener('change', recolour);

  let opened: HTMLDetailsElement[] = [],
    theme: string | undefined;
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll<HTMLDetailsElement>('details:not([open])')].filter(details =>
      details.querySelector('math'),
    );
    for (const details of opened) details.open = true;
    theme = root.dataset.theme;
    root.dataset.theme = 'light';
    recolour();
  });
  addEventListener('afterprint', () => {
    for (const details of opened) details.open = false;
    if (theme) root.dataset.theme = theme;
    else delete root.dataset.theme;
    recolour();
  });
}
