// The gallery: a card a model, and a page a model with its motion, its text, its equations and their certificate.
import {execFile} from 'node:child_process';
import {existsSync, mkdirSync, readFileSync, readdirSync} from 'node:fs';
import {basename, join} from 'node:path';
import {escape} from './highlight.mjs';
import {katexHtml} from './formula.mjs';
import {together} from './program.mjs';
import {italic, prose} from './prose.mjs';
import {fragmentOf} from './studio.mjs';

// What a model is about, by the statements that it has; the first group that fits.
const groups = [
  ['Fields', model => model.folder === 'fields'],
  ['Degenerate Lagrangians', model => model.folder === 'degenerate'],
  ['Paths of stationary action', model => /^path /m.test(model.text)],
  ['Contacts, impacts and dry friction', model => /^(contact|friction|impact) /m.test(model.text)],
  [
    'Rolling and other non-holonomic systems',
    model => /is nonholonomic/m.test(model.text) || /^constraint .*'/m.test(model.text),
  ],
  ['Mechanisms and constraints', model => /^constraint /m.test(model.text)],
  ['Rigid bodies and frames', model => /^(body|frame) /m.test(model.text)],
  ['Particles', () => true],
];
const order = [
  'Particles',
  'Rigid bodies and frames',
  'Mechanisms and constraints',
  'Rolling and other non-holonomic systems',
  'Contacts, impacts and dry friction',
  'Fields',
  'Paths of stationary action',
  'Degenerate Lagrangians',
];

export function readModels(root) {
  const table = new Map(
    [
      ...readFileSync(join(root, 'models/README.md'), 'utf8').matchAll(
        /^\| \[(\w+)\]\([^)]*\) \| (.*?) \| (.*?) \|$/gm,
      ),
    ].map(([, name, shows, against]) => [name, {shows, against}]),
  );
  const models = [];
  for (const folder of ['', 'degenerate', 'fields']) {
    for (const file of readdirSync(join(root, 'models', folder))
      .filter(file => file.endsWith('.lag'))
      .sort()) {
      const name = basename(file, '.lag'),
        text = readFileSync(join(root, 'models', folder, file), 'utf8');
      const title = text.match(/^system \w+ "([^"]*)"/m)?.[1] ?? name,
        source = text.match(/^source "([^"]*)"/m)?.[1];
      if (models.some(model => model.name === name)) throw new Error(`two models are called ${name}`);
      models.push({
        name,
        folder,
        text,
        title,
        source,
        file: join(root, 'models', folder, file),
        path: `models/${name}.html`,
        ...table.get(name),
      });
    }
  }
  for (const model of models) model.group = groups.find(([, fits]) => fits(model))[0];
  return models.sort((a, b) => order.indexOf(a.group) - order.indexOf(b.group));
}

// Picture, film and equations of each model, from the program.
export async function studyModels(root, models, program, width) {
  mkdirSync(join(program.folder, 'pictures'));
  await together(models, width, async model => {
    model.picture = await picture(root, model, program);
    model.film = filmOf(await program.written(`${model.name}.html`, 'animate', model.file), model);
    model.derivation = JSON.parse((await program.run('derive', '--json', '--steps', model.file)).out);
    model.expectations = await expectationsOf(model, program);
  });
}

// A model whose tests fail is not shown as if they held.
async function expectationsOf(model, program) {
  const {expectations} = JSON.parse((await program.run('test', '--json', model.file)).out);
  const failed = expectations.find(expectation => !expectation.passed);
  if (failed) throw new Error(`${model.name}: \`${failed.text}\` does not hold`);
  return expectations;
}

function picture(root, model, program) {
  const file = join(program.folder, 'pictures', `${model.name}.svg`),
    name =
      model.folder === 'degenerate'
        ? `degenerate/${model.name}`
        : model.folder
          ? `${model.folder}/${model.name}`
          : model.name;
  return new Promise(done =>
    execFile(
      join(root, 'scripts/gallery'),
      ['--one', name, file],
      {env: {...process.env, MAUP: program.path}},
      error => {
        done(!error && existsSync(file) ? readFileSync(file, 'utf8') : null);
      },
    ),
  );
}

// Of the page that `maup animate` writes: what moves, and the scripts that move it. {html, kind, script}
function filmOf(page, model) {
  if (page === null) return null;
  const main = page.match(/<main>\n?([\s\S]*?)<\/main>/)?.[1];
  // Without the script that changes light and dark: the site has its own.
  const scripts = [...page.matchAll(/<script>\n?([\s\S]*?)<\/script>/g)].map(match => match[1]);
  const script = scripts.filter(text => !text.includes("getElementById('theme')")).join('\n');
  if (!main) throw new Error(`${model.name}: the page of maup animate has no <main>`);
  if (main.includes('id="drawing-data"')) return {kind: 'drawing', html: main.trim(), script};
  const data = page.match(/<script type="application\/json" id="drawing-data">[\s\S]*?<\/script>/)?.[0];
  if (data) return {kind: 'drawing', html: `${main.trim()}\n${data}`, script};
  if (!main.includes('id="film"'))
    throw new Error(`${model.name}: neither a drawing nor a film on the page of maup animate`);
  const html = main.replace('<svg ', `<svg aria-label="${escape(model.title)}, in motion" `).trim();
  return {kind: 'film', html, script};
}

// ----------------------------------------------------------------------------------------------------------- pages

const formulas = (rows, where) =>
  rows
    .map(
      row =>
        `<div class="formula${row.latex.includes('\\frac') ? ' tall' : ''}">${katexHtml(row.latex, where)}
${row.where ? `<span class="said">${escape(row.where)}</span>` : ''}</div>\n`,
    )
    .join('');

/** 2.5 · 10⁻²⁰ */
function power(x) {
  const [mantissa, exponent] = x.toExponential(1).split('e');
  return `${mantissa} · 10<sup>${Number(exponent)}</sup>`.replace('>-', '>−');
}

function certificate({certificate}) {
  if (!certificate) return '';
  const rows = certificate.checks.map(
    check =>
      `<tr><td><code>${escape(check.name)}</code></td>
<td>${escape(check.statement)}</td>
<td class="number">${check.points}</td>
<td class="number">${check.error_bound ? power(check.error_bound) : '0'}</td></tr>`,
  );
  const [manner, word] = certificate.passed ? ['good', 'Passed'] : ['bad', 'Not passed'];
  return `<h2 id="certificate">Certificate</h2>
<p class="${manner}">${word}: ${certificate.checks.length} independent checks of the derivation.
<a href="../theory/certificate.html">What they are</a></p>
<div class="scroll"><table><thead><tr>
<th scope="col">check</th><th scope="col">says</th><th scope="col">points</th><th scope="col">error below</th>
</tr></thead><tbody>${rows.join('\n')}</tbody></table></div>\n`;
}

function tests({expectations}) {
  const rows = expectations.map(
    ({text, actual, message}) => `<tr><td><code>${escape(text)}</code></td>
<td><code>${escape(actual)}</code> <span class="muted">${escape(message)}</span></td></tr>`,
  );
  if (rows.length === 0) return '';
  const all =
    rows.length === 1 ? 'The expectation of the model holds' : `All ${rows.length} expectations of the model hold`;
  return `<h2 id="tests">Tests</h2>
<p><span class="good">${all}</span>, as found by <code>maup test</code> when this page was made.</p>
<div class="scroll"><table class="tests"><thead><tr><th scope="col">expected</th><th scope="col">found</th></tr></thead>
<tbody>${rows.join('\n')}</tbody></table></div>\n`;
}

function equations(model) {
  const d = model.derivation,
    where = model.name;
  if (!d.ok) return `<h2 id="equations">Equations</h2>\n${messages(d)}`;
  const part = (name, rows) =>
    rows?.length ? `<h3 id="${name.toLowerCase().replace(/\W+/g, '-')}">${name}</h3>\n${formulas(rows, where)}` : '';
  const nameOf = name => (name === 'energy' ? 'the energy function' : code(name));
  const unit = r => (r.unit ? ` (${escape(r.unit)})` : '');
  const code = text => `<code>${escape(text)}</code>`;
  let html = `<h2 id="equations">Equations</h2>\n${formulas(d.equations ?? [], where)}`;
  html +=
    part('Rates', d.rates) +
    part('Kinematics', d.kinematics) +
    part('Constraints', d.constraints) +
    part('Bodies', d.fields ? d.coordinates : []);
  html += part('Natural boundary conditions', d.natural) + part('Where fields and bodies meet', d.interfaces);
  if (d.degenerate?.constraints?.length)
    html += part(
      'What every state of a motion obeys',
      d.degenerate.constraints.map(c => ({latex: `${c.latex} = 0`})),
    );
  if (d.reactions?.length)
    html += `<h3 id="reactions">Reactions</h3>
<ul>${d.reactions.map(r => `<li>${code(r.plain)}${unit(r)}: ${escape(r.meaning)}</li>`).join('\n')}</ul>\n`;
  html += part('Lagrangian', step(d, s => s.section === 'Lagrangian'));
  if (d.energy_latex) html += part('Energy function', [{latex: `h_E = ${d.energy_latex}`}]);
  html += part('Momenta', step(d, s => / the momentum p_/.test(s.rule)));
  if (d.conserved?.length) html += `<p>Conserved: ${d.conserved.map(nameOf).join(', ')}.</p>\n`;
  return html + derivation(d, where) + messages(d);
}

const step = ({steps}, wanted) => (steps ?? []).filter(s => s.latex && wanted(s));

/** A sentence with θ1 and p_θ1 in it. */
const named = text =>
  italic(
    prose(
      escape(text)
        .replace(/^\p{Ll}(?=\p{Ll})/u, first => first.toUpperCase())
        .replace(/(?<![\p{L}\p{N}])p_([\p{L}\p{N}]+)/gu, 'p<sub>$1</sub>')
        .replace(/(?<![\p{L}\p{N}])(\p{L})(\d+)(?![\p{L}\p{N}])/gu, '$1<sub>$2</sub>'),
    ),
  );

/** The steps from the text to the equations, to be unfolded; of long ones one is better served by `maup report`. */
const longest = 8000;
function derivation({steps}, where) {
  if (!steps?.length || steps.reduce((sum, s) => sum + s.latex.length, 0) > longest) return '';
  let html = '',
    section = '';
  for (const s of steps) {
    if (s.section !== section) html += `<h4>${named((section = s.section))}</h4>\n`;
    const formula = s.latex && formulas([s], where);
    const words = named([s.rule, s.sentence].filter(Boolean).join('. '));
    html += `<div class="step">${formula}<p class="muted">${words}</p></div>\n`;
  }
  return `<details class="derivation"><summary>The derivation, ${steps.length} steps</summary>\n${html}</details>\n`;
}

const messages = ({diagnostics}) =>
  (diagnostics ?? [])
    .map(
      d =>
        `<div class="remark ${d.severity}">
<p><a href="../diagnostics/${d.code}.html"><code>${d.code}</code></a> ${escape(d.message)}</p>
${[d.reason, d.help]
  .filter(Boolean)
  .map(text => `<p>${marked(text)}</p>`)
  .join('\n')}</div>\n`,
    )
    .join('');

const marked = text => escape(text).replace(/`([^`]+)`/g, '<code>$1</code>');

export function modelPages(models, documents, {studio}) {
  const list = {
    label: 'Models',
    pages: [
      ['models/index.html', 'Gallery'],
      ...order.flatMap(group => [[group], ...models.filter(m => m.group === group).map(m => [m.path, m.title])]),
    ],
  };
  return models.map(model => {
    const film = model.film
      ? model.film.html
      : model.picture
        ? `<figure class="still"><img src="pictures/${model.name}.svg" alt="${escape(model.title)}"></figure>`
        : '';
    const links = [`<a class="button" href="text/${model.name}.lag" download>${model.name}.lag</a>`];
    if (studio)
      links.unshift(
        `<a class="button main" href="studio:#${fragmentOf(model.text, model.name)}">Open in the studio</a>`,
      );
    const against = model.shows && `<span class="muted">Compared with: ${marked(model.against)}.</span>`;
    const html = `${model.source ? `<p class="citation">${escape(model.source)}</p>\n` : ''}
${model.shows ? `<p class="lead">${sentence(marked(model.shows))} ${against}</p>\n` : ''}${film}
<p class="actions">${links.join(' ')}
<span class="muted">or <code>maup report models/${model.folder && `${model.folder}/`}${model.name}.lag</code></span></p>
<h2 id="text">Model</h2>
${documents.lag(model.text.trimEnd(), false)}${equations(model)}${certificate(model.derivation)}${tests(model)}`;
    const headings = [...html.matchAll(/<h([23]) id="([^"]*)">(.*?)<\/h/g)].map(([, level, id, text]) => ({
      level: Number(level),
      id,
      text,
    }));
    return {
      path: model.path,
      title: model.title,
      html,
      headings,
      contents: false,
      list,
      scripts: scriptsOf(model),
      sections: [
        {title: model.title, id: '', text: `${model.name} ${model.shows ?? ''} ${model.source ?? ''} ${model.text}`},
      ],
    };
  });
}

// Films of fields have a script each, which knows how long they last.
function scriptsOf({name, film}) {
  return !film ? [] : film.kind === 'drawing' ? ['assets/drawing.js'] : [`models/film/${name}.js`];
}

const sentence = html => html.replace(/^./, first => first.toUpperCase()) + '.';

function card(model, studio) {
  const {name, title, shows, source, group, picture, derivation} = model;
  const words = [name, title, shows, source, group].filter(Boolean).join(' ').toLowerCase();
  const shown = picture
    ? `<img src="pictures/${name}.svg" alt="" loading="lazy" width="480" height="330">`
    : `<span class="formula">${derivation.ok ? katexHtml(derivation.equations[0].latex, name) : ''}</span>`;
  const open = `<a class="open" href="studio:#${fragmentOf(model.text, name)}"
 aria-label="open in the studio: ${escape(title)}">open in the studio</a>`;
  return `<li class="card" data-words="${escape(words)}">
<a href="${name}.html">${shown}
<b>${escape(title)}</b></a>
<p>${shows ? sentence(marked(shows)) : ''}</p>${studio ? open : ''}</li>`;
}

export function galleryPage(models, {studio}) {
  const sections = order
    .map(group => [group, models.filter(model => model.group === group)])
    .filter(([, list]) => list.length)
    .map(
      ([group, list]) =>
        `<section data-group><h2 id="${group.toLowerCase().replace(/\W+/g, '-')}">${group}</h2>
<ul class="cards">${list.map(model => card(model, studio)).join('\n')}</ul></section>\n`,
    );
  return {
    path: 'models/index.html',
    title: 'Models',
    wide: true,
    contents: false,
    html: `<p class="lead">${models.length} systems, each with its source, its equations and the certificate of their
derivation; in their files are the tests that compare them with values from outside. Reference cases of the literature
are <a href="../inside/reference_cases.html">listed apart</a>.</p>
<p class="filter"><label for="filter">Filter</label>
<input id="filter" type="search" autocomplete="off" spellcheck="false" placeholder="pendulum, rolling, Goldstein …">
<output id="filter-count" for="filter"></output></p>
${sections.join('')}`,
    sections: [{title: 'Models', id: '', text: 'gallery of all models'}],
  };
}

// The cases of the literature have their text alone.
export function problemPages(root, documents, {studio}) {
  const folder = join(root, 'tests/problems');
  return readdirSync(folder)
    .filter(name => name.endsWith('.lag'))
    .sort()
    .map(file => {
      const text = readFileSync(join(folder, file), 'utf8'),
        name = basename(file, '.lag'),
        title = text.match(/^system \w+ "([^"]*)"/m)?.[1] ?? name;
      const link = studio
        ? `<p class="actions"><a class="button main" href="studio:#${fragmentOf(text, name)}">
Open in the studio</a></p>\n`
        : '';
      return {
        file: `tests/problems/${file}`,
        path: `problems/${name}.html`,
        title,
        documentTitle: `${name}: ${title}`,
        formulas: false,
        contents: false,
        area: 'inside/index.html',
        html: `<p class="muted"><code>tests/problems/${file}</code>, of the
<a href="../inside/reference_cases.html">reference cases</a></p>
${link}${documents.lag(text.trimEnd(), false)}`,
        sections: [{title, id: '', text: name}],
      };
    });
}
