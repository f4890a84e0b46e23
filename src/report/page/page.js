// What the page does beside the animation: the reader's choice of light or dark, and all steps open on paper.
'use strict';
(() => {
  const root = document.documentElement, button = document.getElementById('theme');
  const dark = () =>
    root.dataset.theme ? root.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
  const repaint = () => document.dispatchEvent(new Event('maup-theme'));
  const name = () => button.setAttribute('aria-label', dark() ? 'Light page' : 'Dark page');
  button.addEventListener('click', () => {
    root.dataset.theme = dark() ? 'light' : 'dark';
    name();
    repaint();
  });
  name();

  let opened = [], theme;
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll('details:not([open])')];
    for (const details of opened) details.open = true;
    theme = root.dataset.theme;
    root.dataset.theme = 'light';
    repaint();
  });
  addEventListener('afterprint', () => {
    for (const details of opened) details.open = false;
    if (theme) root.dataset.theme = theme; else delete root.dataset.theme;
    repaint();
  });
  const all = document.getElementById('all-steps');
  all?.addEventListener('click', () => {
    const steps = [...document.querySelectorAll('#derivation details')], open = !steps.every(details => details.open);
    for (const details of steps) details.open = open;
    all.textContent = open ? 'close all' : 'open all';
  });
})();
