// The frame of every page: head, banner, the list of pages beside the text, what is on this page, the next one.
import {escape} from './highlight.mjs';
import {posix} from 'node:path';

export const areas = [
  ['models/index.html', 'Models'],
  ['manual/index.html', 'Manual'],
  ['theory/index.html', 'Theory'],
  ['diagnostics/index.html', 'Diagnostics'],
  ['benchmarks.html', 'Benchmarks'],
  ['api/index.html', 'API'],
  ['inside/index.html', 'Inside'],
];

// Styles within elements are KaTeX's.
const policy = [
  "default-src 'none'",
  "script-src 'self'",
  "style-src 'self' 'unsafe-inline'",
  "img-src 'self' data:",
  "font-src 'self'",
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

export const relative = (from, to) => {
  const [path, anchor] = to.split('#');
  const way =
    path === '' || path === from
      ? anchor === undefined
        ? posix.basename(from)
        : ''
      : posix.relative(posix.dirname(from), path);
  return way + (anchor === undefined ? '' : `#${anchor}`);
};

const themeIcon = `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="M12 3a9 9 0 1 0 0 18V3z"/>
<circle cx="12" cy="12" r="9" fill="none" stroke="currentColor" stroke-width="1.4"/></svg>`;

/// page: {path, title, html, headings, list: {label, pages: [[path, title], …]}, scripts, description, wide}
export function pageHtml(page, {studio}) {
  const at = to => escape(relative(page.path, to));
  const area =
    page.area ?? areas.find(([path]) => path === page.path || page.path.startsWith(posix.dirname(path) + '/'))?.[0];
  const links = areas.map(
    ([path, name]) => `<a href="${at(path)}"${path === area ? ' aria-current="true"' : ''}>${name}</a>`,
  );
  if (studio) links.push(`<a href="${at('studio/index.html')}">Studio</a>`);
  const heading = page.start ? '' : `<h1>${page.titleHtml ?? escape(page.title)}</h1>\n`;
  const list = page.list ? listHtml(page, at) : '',
    onPage = contents(page);
  const columns = ['frame', list && 'listed', onPage && 'contented', page.wide && 'wide'].filter(Boolean).join(' ');
  const html = page.html.replaceAll('href="studio:', `href="${at('studio/index.html')}`);
  return `<!DOCTYPE html>
<html lang="en">
<head>
${headHtml(page, at)}</head>
<body data-root="${escape(relative(page.path, 'index.html').replace(/index\.html$/, ''))}">
<a class="skip" href="#content">Skip to the text</a>
<header class="banner">
<a class="brand" href="${at('index.html')}"${page.start ? ' aria-current="page"' : ''}>Maupertuis</a>
<nav aria-label="Site">${links.join('\n')}</nav>
<div class="tools">${searchField}
<button id="theme" type="button" aria-label="Dark page">${themeIcon}</button></div>
</header>
<div class="${columns}">
${list}${onPage}<main id="content" tabindex="-1">
${heading}${html}${neighbours(page, at)}</main>
</div>
<footer class="end"><p>Maupertuis, Lagrangian mechanics from a text file. Apache-2.0.
This site asks no server for anything. <a href="${at('inside/changes.html')}">What changed</a></p></footer>
${[...(page.scripts ?? []), 'assets/site.js'].map(script => `<script src="${at(script)}"></script>\n`).join('')}</body>
</html>
`;
}

const searchField = `<search><label class="unseen" for="search">Search the site</label>
<input id="search" type="search" placeholder="Search" autocomplete="off" spellcheck="false" role="combobox"
 aria-expanded="false" aria-controls="found" aria-autocomplete="list">
<ul id="found" role="listbox" aria-label="Found" hidden></ul></search>`;

function headHtml(page, at) {
  const title = page.start ? page.title : `${page.documentTitle ?? page.title} – Maupertuis`;
  const styles = page.formulas === false ? ['assets/style.css'] : ['assets/style.css', 'assets/katex/katex.min.css'];
  return `<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<title>${escape(title)}</title>
${page.description ? `<meta name="description" content="${escape(page.description)}">\n` : ''}\
<link rel="icon" href="${at('assets/icon.svg')}">
${styles.map(style => `<link rel="stylesheet" href="${at(style)}">\n`).join('')}\
<script src="${at('assets/theme.js')}"></script>
`;
}

function listHtml({path, list}, at) {
  const items = list.pages.map(entry =>
    entry.length === 1
      ? `</ul>\n<p class="group">${escape(entry[0])}</p>\n<ul>`
      : `<li><a href="${at(entry[0])}"${entry[0] === path ? ' aria-current="page"' : ''}>${escape(entry[1])}</a></li>`,
  );
  return `<nav class="pages" aria-label="${escape(list.label)}"><details open><summary>${escape(list.label)}</summary>
<ul>${items.join('\n')}</ul></details></nav>\n`.replace('<ul></ul>\n', '');
}

function contents({headings, contents}) {
  const shown = (headings ?? []).filter(h => h.level <= 3);
  if (contents === false || shown.length < 3) return '';
  return `<nav class="contents" aria-label="On this page"><details open><summary>On this page</summary><ul>${shown
    .map(h => `<li class="level${h.level}"><a href="#${escape(h.id)}">${escape(h.text)}</a></li>`)
    .join('\n')}</ul></details></nav>\n`;
}

function neighbours({path, list}, at) {
  if (!list || list.neighbours === false) return '';
  const pages = list.pages.filter(entry => entry.length > 1),
    i = pages.findIndex(([p]) => p === path);
  if (i < 0) return '';
  const link = (entry, word, rel) =>
    entry ? `<a rel="${rel}" href="${at(entry[0])}"><span>${word}</span> ${escape(entry[1])}</a>` : '<span></span>';
  const links = link(pages[i - 1], 'before', 'prev') + link(pages[i + 1], 'next', 'next');
  return `<nav class="neighbours" aria-label="Neighbouring pages">${links}</nav>\n`;
}
