// What can be said of the pages without a browser: links, anchors, headings, alternatives, requests, leftovers.
import {existsSync, readFileSync, readdirSync, statSync} from 'node:fs';
import {dirname, join, normalize, relative} from 'node:path';

const decode = text =>
  text
    .replaceAll('&quot;', '"')
    .replaceAll('&#39;', "'")
    .replaceAll('&lt;', '<')
    .replaceAll('&gt;', '>')
    .replaceAll('&amp;', '&');

export function pagesOf(site) {
  return readdirSync(site, {recursive: true})
    .map(String)
    .filter(name => name.endsWith('.html'))
    .sort();
}

export function checkFiles(check, site) {
  const pages = pagesOf(site),
    anchors = new Map(),
    titles = new Map();
  const idsOf = file => {
    if (!anchors.has(file))
      anchors.set(
        file,
        new Set([...readFileSync(file, 'utf8').matchAll(/\sid="([^"]*)"/g)].map(match => decode(match[1]))),
      );
    return anchors.get(file);
  };
  const wrong = {link: [], anchor: [], outside: [], heading: [], ids: [], alternative: [], leftover: [], title: []};
  let links = 0;
  for (const page of pages.filter(page => !page.startsWith('studio/'))) {
    const file = join(site, page),
      html = readFileSync(file, 'utf8'),
      text = html.replace(/<script type="application\/json"[\s\S]*?<\/script>/g, '');
    for (const [, name, value] of text.matchAll(/<[^>]*?\s(href|src)="([^"]*)"/g)) {
      const target = decode(value);
      if (/^(data:|mailto:)/.test(target)) continue;
      if (/^([a-z]+:|\/)/i.test(target)) {
        wrong.outside.push(`${page}: ${name}=${target}`);
        continue;
      }
      ++links;
      const [path, anchor] = target.split('#'),
        to = path === '' ? file : normalize(join(dirname(file), decodeURI(path)));
      if (!existsSync(to) || statSync(to).isDirectory()) wrong.link.push(`${page}: ${target}`);
      else if (
        anchor &&
        to.endsWith('.html') &&
        !relative(site, to).startsWith('studio') &&
        !idsOf(to).has(decodeURIComponent(anchor))
      )
        wrong.anchor.push(`${page}: ${target}`);
    }
    const levels = [...text.matchAll(/<h([1-6])[\s>]/g)].map(match => Number(match[1]));
    if (
      levels[0] !== 1 ||
      levels.filter(level => level === 1).length !== 1 ||
      levels.some((level, i) => i > 0 && level > levels[i - 1] + 1)
    )
      wrong.heading.push(`${page}: ${levels.join('')}`);
    const ids = [...text.matchAll(/\sid="([^"]*)"/g)].map(match => match[1]),
      twice = ids.find((id, i) => ids.indexOf(id) !== i);
    if (twice !== undefined) wrong.ids.push(`${page}: ${twice}`);
    if (/<img(?![^>]*\salt=)[^>]*>/.test(text)) wrong.alternative.push(page);
    if (/katex-error|\[object Object\]|>undefined<|studio:#/.test(text)) wrong.leftover.push(page);
    const title = text.match(/<title>(.*?)<\/title>/)?.[1];
    if (titles.has(title)) wrong.title.push(`${page} and ${titles.get(title)}: ${title}`);
    titles.set(title, page);
  }
  const says = {
    link: 'every link leads to a file',
    anchor: 'every anchor exists',
    outside: 'nothing leads out of the site',
    heading: 'headings are in order',
    ids: 'every id stands once',
    alternative: 'every picture has its alternative',
    leftover: 'nothing is left over of the making',
    title: 'every page has a title of its own',
  };
  for (const [kind, list] of Object.entries(wrong))
    check(says[kind], list.length === 0, list.slice(0, 8).concat(list.length > 8 ? [`… ${list.length}`] : []));
  check(
    'there are as many pages and links as there must be',
    pages.length > 600 && links > 20000,
    `${pages.length} pages, ${links} links`,
  );
  return {pages, links};
}
