// Every message that the program can give, a page a code, with texts that call it forth and what is said then.
import {existsSync, readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {escape} from './highlight.mjs';
import {consoleHtml} from './markdown.mjs';

const ranges = {
  '01': 'Text and grammar',
  '02': 'Names and statements',
  '03': 'Units',
  '04': 'Kinematics and physics',
  '05': 'Not supported yet',
  '06': 'Equations and their certificate',
  '07': 'Runs',
  '08': 'Files and the command line',
  '09': 'Expectations',
  10: 'Invariants',
  11: 'Phase space',
  12: 'Action',
  13: 'Equilibria and modes',
  14: 'Orbits',
};
const severities = {E: 'error', W: 'warning', N: 'note'};

// Of each code the shortest text of tests/golden that gives it, with the whole answer.
function examples(root) {
  const found = new Map();
  for (const folder of ['reject', 'accept'].map(name => join(root, 'tests/golden', name))) {
    if (!existsSync(folder)) continue;
    for (const name of readdirSync(folder).filter(name => name.endsWith('.lag'))) {
      const expected = join(folder, name.replace(/\.lag$/, '.expected'));
      if (!existsSync(expected)) continue;
      const text = readFileSync(join(folder, name), 'utf8'),
        message = readFileSync(expected, 'utf8');
      for (const [, code] of message.matchAll(/^-- (?:error|warning|note) ([EWN]\d{4}) /gm)) {
        const only = (message.match(/^-- /gm) ?? []).length,
          old = found.get(code);
        if (!old || only < old.only || (only === old.only && text.length < old.text.length))
          found.set(code, {name, text, message, only});
      }
    }
  }
  return found;
}

export function diagnosticsPages(root, program, documents) {
  const {codes} = program.json('explain'),
    shown = examples(root);
  const groups = new Map();
  for (const code of codes) {
    const range = code.code.slice(1, 3);
    if (!groups.has(range)) groups.set(range, []);
    groups.get(range).push(code);
  }
  const title = range => ranges[range] ?? `${range}xx`;
  const sorted = [...groups].sort(([a], [b]) => a.localeCompare(b));
  const pages = [];
  for (const [range, entries] of sorted) {
    const list = {
      label: title(range),
      pages: [
        ['diagnostics/index.html', 'All codes'],
        [title(range)],
        ...entries.map(entry => [`diagnostics/${entry.code}.html`, `${entry.code} ${entry.title}`]),
      ],
    };
    for (const entry of entries)
      pages.push({
        ...codePage(entry, shown.get(entry.code), documents),
        list,
        area: 'diagnostics/index.html',
        range: title(range),
      });
  }
  const index = sorted
    .map(
      ([range, entries]) =>
        `<section data-group><h2 id="range-${range}">${range}xx ${escape(title(range))}</h2>
<ul class="codes">${entries
          .map(
            ({code, title, explanation}) =>
              `<li data-words="${escape(`${code} ${title} ${explanation}`.toLowerCase())}"><a href="${code}.html">
<code class="${severities[code[0]]}">${code}</code> ${escape(title)}</a></li>`,
          )
          .join('\n')}</ul></section>\n`,
    )
    .join('');
  pages.unshift({
    path: 'diagnostics/index.html',
    title: 'Diagnostics',
    documentTitle: 'All diagnostics',
    contents: false,
    formulas: false,
    html: `<p class="lead">Everything that <code>maup</code> may have to say of a model: ${codes.length} codes,
each with its reason, its remedy, and where that helps a text that is wrong beside one that is right. How messages are
built is told in <a href="../manual/diagnostics.html">the manual</a>; <code>maup explain CODE</code>
says the same in a terminal.</p>
<p class="filter"><label for="filter">Filter</label>
<input id="filter" type="search" autocomplete="off" spellcheck="false">
<output id="filter-count" for="filter"></output></p>\n${index}`,
  });
  return {pages, codes: codes.length, examples: codes.filter(({code, wrong}) => wrong || shown.has(code)).length};
}

const capital = text => text.replace(/^./u, first => first.toUpperCase());

/** A model, or command lines. */
const exampleHtml = (text, documents) =>
  /^(maup|iconv|MAUPERTUIS_\w+=\S+) /.test(text)
    ? `<pre class="console"><code>${consoleHtml(text.replace(/^/gm, '$ '))}</code></pre>\n`
    : documents.lag(text, false);

function codePage({code, title, explanation, wrong, right}, example, documents) {
  const kind = severities[code[0]];
  const paragraphs = explanation
    .split(/\n\n+/)
    .map(text => `<p>${escape(text).replace(/`([^`]+)`/g, '<code>$1</code>')}</p>`)
    .join('\n');
  const listing = (heading, text) =>
    text ? `<h2 id="${heading.toLowerCase()}">${heading}</h2>\n${exampleHtml(text.trimEnd(), documents)}` : '';
  const message = example
    ? `<h2 id="example">A model, and what is said of it</h2>
${documents.lag(example.text.trimEnd(), true)}
<pre class="message"><code>${escape(example.message.trimEnd())}</code></pre>
<p class="source">From the tests of the program, <code>tests/golden/reject/${escape(example.name)}</code>.</p>\n`
    : '';
  return {
    path: `diagnostics/${code}.html`,
    title: `${code}: ${title}`,
    titleHtml: `<code class="${kind}">${code}</code> ${escape(capital(title))}`,
    formulas: false,
    contents: false,
    html: `<p class="kind">${capital(kind)}.</p>
${paragraphs}
${listing('Wrong', wrong)}${listing('Right', right)}${message}`,
    sections: [{title: `${code} ${title}`, id: '', text: explanation}],
  };
}
