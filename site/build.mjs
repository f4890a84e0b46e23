// Builds the static site:
//   node site/build.mjs [--maup build/bin/maup] [--out build/site] [--studio build/studio_static]
// All comes from the repository and from what the program says; a page that cannot be made right fails the build.
import {cpSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, writeFileSync} from 'node:fs';
import {availableParallelism} from 'node:os';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {build as bundle} from 'esbuild';
import {ApiPages, readHeaders} from './source/api.mjs';
import {benchmarkPlots, logPlot} from './source/plots.mjs';
import {DocumentPages} from './source/documents.mjs';
import {diagnosticsPages} from './source/diagnostics.mjs';
import {Highlighter, escape} from './source/highlight.mjs';
import {Documents} from './source/markdown.mjs';
import {galleryPage, modelPages, problemPages, readModels, studyModels} from './source/models.mjs';
import {pageHtml} from './source/layout.mjs';
import {Program} from './source/program.mjs';
import {startPage} from './source/start.mjs';
import {copyStudio, fragmentOf, missingOf} from './source/studio.mjs';

const here = dirname(fileURLToPath(import.meta.url)),
  root = resolve(here, '..');
const {values} = parseArgs({
  options: {
    maup: {type: 'string', default: join(root, 'build/bin/maup')},
    out: {type: 'string', default: join(root, 'build/site')},
    studio: {type: 'string', default: join(root, 'build/studio_static')},
  },
});
const out = resolve(values.out),
  making = `${out}.new`,
  packages = name => join(here, 'node_modules', name);

const write = (path, text) => {
  const file = join(making, path);
  mkdirSync(dirname(file), {recursive: true});
  writeFileSync(file, text);
};

async function assets(models) {
  cpSync(join(here, 'icon.svg'), join(making, 'assets/icon.svg'));
  const katexStyle = readFileSync(packages('katex/dist/katex.min.css'), 'utf8').replace(
    /,url\([^)]*\.(?:woff|ttf)\) format\("[^"]*"\)/g,
    '',
  );
  write('assets/katex/katex.min.css', katexStyle);
  for (const font of readdirSync(packages('katex/dist/fonts')).filter(name => name.endsWith('.woff2')))
    cpSync(packages(`katex/dist/fonts/${font}`), join(making, 'assets/katex/fonts', font));
  for (const [subset, weight, style] of [
    ['latin', 400, 'normal'],
    ['latin', 400, 'italic'],
    ['latin', 500, 'normal'],
    ['latin', 700, 'normal'],
    ['greek', 400, 'normal'],
    ['greek', 400, 'italic'],
    ['latin-ext', 400, 'normal'],
  ])
    cpSync(
      packages(`@fontsource/stix-two-text/files/stix-two-text-${subset}-${weight}-${style}.woff2`),
      join(making, `assets/fonts/stix-${subset}-${weight}-${style}.woff2`),
    );
  cpSync(packages('@fontsource/stix-two-text/LICENSE'), join(making, 'assets/fonts/LICENSE'));
  cpSync(packages('katex/LICENSE'), join(making, 'assets/katex/LICENSE'));
  const common = {
    bundle: true,
    minify: true,
    charset: 'utf8',
    format: 'iife',
    target: 'es2022',
    logLevel: 'warning',
    legalComments: 'none',
  };
  for (const name of ['site', 'theme', 'pendulum', 'derive'])
    await bundle({
      ...common,
      entryPoints: [join(here, `browser/${name}.js`)],
      outfile: join(making, `assets/${name}.js`),
    });
  await bundle({
    ...common,
    bundle: false,
    entryPoints: [join(here, 'style.css')],
    outfile: join(making, 'assets/style.css'),
    format: undefined,
  });
  write('assets/drawing.js', models.find(model => model.film?.kind === 'drawing').film.script);
  for (const model of models) {
    if (model.picture) write(`models/pictures/${model.name}.svg`, model.picture);
    if (model.film?.kind === 'film') write(`models/film/${model.name}.js`, `'use strict';\n${model.film.script}`);
    write(`models/text/${model.name}.lag`, model.text);
  }
}

function benchmarks(documents) {
  const file = 'docs/benchmarks.md',
    text = readFileSync(join(root, file), 'utf8');
  const page = documents.render(text, file),
    plots = benchmarkPlots(text);
  let drawn = 0;
  const html = page.html.replace(/<p><img src="[^"]*pictures\/(\w+)\.svg" alt="[^"]*"><\/p>/g, (all, name) => {
    if (!plots[name])
      throw new Error(`docs/benchmarks.md shows ${name}.svg, and site/source/plots.mjs has no plot of it`);
    ++drawn;
    return logPlot(plots[name]);
  });
  if (drawn !== Object.keys(plots).length)
    throw new Error(`${drawn} plots of docs/benchmarks.md are shown of ${Object.keys(plots).length}`);
  return {...page, html, path: 'benchmarks.html', area: 'benchmarks.html'};
}

const grammarPage = docs => ({
  path: 'manual/grammar.html',
  title: 'Grammar',
  formulas: false,
  contents: false,
  list: docs.listOf('manual'),
  html: `<p class="lead">The grammar of the model language in EBNF, which the tests of the parser follow.</p>
<pre><code>${escape(readFileSync(join(root, 'docs/manual/grammar.ebnf'), 'utf8').trimEnd())}</code></pre>\n`,
});

// kind, page, address, title, text of each part that can be found
function searchTexts(pages) {
  const kinds = {
    models: 'model',
    manual: 'manual',
    theory: 'theory',
    diagnostics: 'diagnostic',
    api: 'API',
    inside: 'inside',
    problems: 'reference case',
  };
  return pages.flatMap(page =>
    (page.sections ?? []).map(section => [
      kinds[page.path.split('/')[0]] ?? 'page',
      page.title,
      page.path + (section.id ? `#${section.id}` : ''),
      section.title,
      section.text.replace(/[|*`]/g, ' ').replace(/\s+/g, ' ').trim(),
    ]),
  );
}

async function main() {
  const started = Date.now(),
    program = new Program(resolve(values.maup));
  if (!existsSync(program.path)) throw new Error(`there is no program ${program.path}; scripts/build makes it`);
  const missing = missingOf(resolve(values.studio)),
    studio = missing === null;
  if (!studio) console.log(`The site is made without the studio and links to it: ${missing}.`);
  rmSync(making, {recursive: true, force: true});
  try {
    const docs = new DocumentPages(root),
      highlighter = new Highlighter(join(root, 'editors/vscode/syntaxes/lag.tmLanguage.json'));
    const documents = new Documents(highlighter, (target, env) => docs.linkOf(target, env), {
      titleOf: (target, env) => docs.titleOf(target, env),
      studioLink: text => (studio ? `studio:#${fragmentOf(text + '\n', text.match(/^system (\w+)/m)?.[1])}` : null),
    });
    const models = readModels(root),
      problems = problemPages(root, documents, {studio});
    for (const model of models)
      docs.addresses.set(`models/${model.folder ? `${model.folder}/` : ''}${model.name}.lag`, model.path);
    for (const problem of problems) docs.addresses.set(problem.file, problem.path);
    await studyModels(root, models, program, Math.min(4, availableParallelism()));
    const diagnostics = diagnosticsPages(root, program, documents),
      api = new ApiPages(root, readHeaders(root, join(program.folder, 'doxygen')));
    const pages = [
      await startPage(models, program, documents, {studio}),
      galleryPage(models, {studio}),
      ...modelPages(models, documents, {studio}),
      ...problems,
      ...docs.pages(documents),
      grammarPage(docs),
      benchmarks(documents),
      ...diagnostics.pages,
      ...api.pages(),
      docs.overview('manual', 'Manual', 'How to write a model, ask about it, and read the answers.'),
      docs.overview(
        'theory',
        'Theory',
        'What is derived, by which rules, and how it is made sure of. The signs are those of the conventions.',
      ),
      docs.overview('inside', 'Inside', 'How the program is built, and why so.'),
    ];
    for (const page of pages) write(page.path, pageHtml(page, {studio}));
    write('assets/search.js', `self.maupSearch=${JSON.stringify(searchTexts(pages))};\n`);
    await assets(models);
    for (const name of readdirSync(join(root, 'docs/pictures')).filter(name => name.endsWith('.png')))
      cpSync(join(root, 'docs/pictures', name), join(making, 'pictures', name));
    if (studio) copyStudio(resolve(values.studio), join(making, 'studio'));
    rmSync(out, {recursive: true, force: true});
    renameSync(making, out);
    console.log(
      `${pages.length} pages in ${out}: ${models.length} models, ${diagnostics.codes} codes ` +
        `(${diagnostics.examples} with an example), ${((Date.now() - started) / 1000).toFixed(0)} s.`,
    );
  } finally {
    program.close();
    rmSync(making, {recursive: true, force: true});
  }
}

main().catch(error => {
  console.error(`The site could not be made: ${error.message}`);
  if (process.env.DEBUG) console.error(error.stack);
  process.exit(1);
});
