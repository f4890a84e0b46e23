// Builds the site (with an empty studio in its place, so that the links to it are there too) and looks at it as readers
// do: in Chromium, from files, at the width of a phone and of a desk, light, dark and on paper, with the
// keyboard, and by axe.
//   node tests/site/check.mjs --maup build/bin/maup --work FOLDER [--keep]   (--keep: the site that is in FOLDER)
import {spawnSync} from 'node:child_process';
import {existsSync, mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {parseArgs} from 'node:util';
import {flags} from '../chromium.mjs';
import {checkFiles} from './files.mjs';
import {checkParts} from './parts.mjs';
import {checkUse} from './use.mjs';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..'),
  from = createRequire(join(root, 'site/package.json'));
const {chromium} = from('playwright-core'),
  axe = readFileSync(from.resolve('axe-core/axe.min.js'), 'utf8');
const {values} = parseArgs({options: {maup: {type: 'string'}, work: {type: 'string'}, keep: {type: 'boolean'}}});
const work = resolve(values.work),
  site = join(work, 'site');

let failures = 0,
  checks = 0;
function check(what, holds, detail = '') {
  ++checks;
  if (holds) return;
  ++failures;
  console.error(
    `FAILED: ${what}${detail === '' ? '' : `: ${typeof detail === 'string' ? detail : JSON.stringify(detail)}`}`,
  );
}

// The pages of a studio, as small as they can be: one for hosts and one for disks.
const studioPage = script => `<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>Studio</title>
<link rel="icon" href="data:,"><script>${script}</script><p>In its place.</p></html>`;
const inItsPlace = {
  'studio/index.html': studioPage("self.opened = 'for hosts';"),
  'studio/studio.html': studioPage("self.opened = 'for disks';"),
};

function build() {
  if (values.keep && existsSync(site)) return;
  rmSync(work, {recursive: true, force: true});
  for (const [name, text] of Object.entries(inItsPlace)) {
    mkdirSync(dirname(join(work, name)), {recursive: true});
    writeFileSync(join(work, name), text);
  }
  const folders = ['--out', site, '--studio', join(work, 'studio')];
  const options = [join(root, 'site/build.mjs'), '--maup', resolve(values.maup), ...folders];
  const {status} = spawnSync(process.execPath, options, {stdio: 'inherit'});
  if (status !== 0) throw new Error('the site was not built');
}

// ----------------------------------------------------------------------------------------------------------- browser

/// A page that notes what a reader must never see: messages on the console, errors, and requests that leave the folder.
export async function open(browser, path, {width = 1600, dark = false, reduced = false} = {}) {
  const context = await browser.newContext({
    viewport: {width, height: width < 600 ? 860 : 1000},
    colorScheme: dark ? 'dark' : 'light',
    reducedMotion: reduced ? 'reduce' : 'no-preference',
  });
  return noting(context, path);
}

async function noting(context, path) {
  const page = await context.newPage(),
    base = pathToFileURL(site).href;
  page.noted = [];
  page.on('console', message => page.noted.push(`console: ${message.text()}`));
  page.on('pageerror', error => page.noted.push(`error: ${error.message}`));
  page.on('request', request => {
    if (!request.url().startsWith(base) && !/^(data|blob):/.test(request.url()))
      page.noted.push(`request: ${request.url()}`);
  });
  page.on('requestfailed', request => {
    const {errorText} = request.failure(); // what is cut off because the page is left is no failure
    if (errorText !== 'net::ERR_ABORTED') page.noted.push(`failed: ${request.url()} ${errorText}`);
  });
  page.siteUrl = path => `${base}/${path}`;
  await page.goto(page.siteUrl(path));
  return page;
}

const kinds = [
  'index.html',
  'models/index.html',
  'models/double_pendulum.html',
  'models/rattleback.html',
  'models/kink_antikink.html',
  'models/maxwell.html',
  'models/hanging_chain.html',
  'manual/index.html',
  'manual/language.html',
  'manual/command_line.html',
  'manual/grammar.html',
  'theory/index.html',
  'theory/fields.html',
  'theory/zero_test.html',
  'benchmarks.html',
  'diagnostics/index.html',
  'diagnostics/E0304.html',
  'api/index.html',
  'api/ensemble.html',
  'inside/index.html',
  'inside/architecture.html',
  'inside/reference_cases.html',
  'inside/kernel_speed.html',
  'problems/celest_kepler_e06.html',
];

// Pages of one view are looked at one after the other in the same window.
async function lookAt(page, path, {width, dark, withAxe}) {
  page.noted.length = 0;
  await page.goto(page.siteUrl(path));
  const where = `${path} at ${width} px${dark ? ', dark' : ''}`;
  await page.evaluate(() =>
    document.fonts.ready.then(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))),
  );
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(`${where}: nothing is wider than the window`, wide <= 0, wide);
  if (withAxe) {
    await page.evaluate(axe);
    const found = await page.evaluate(
      dark =>
        self.axe.run(document, {
          resultTypes: ['violations'],
          ...(dark ? {runOnly: {type: 'rule', values: ['color-contrast', 'link-in-text-block']}} : {}),
        }),
      dark,
    );
    const bad = found.violations
      .filter(v => ['serious', 'critical', 'moderate'].includes(v.impact))
      .map(v => `${v.impact} ${v.id}: ${v.nodes.length} × ${v.nodes[0].html.slice(0, 140)}`);
    check(`${where}: axe finds nothing`, bad.length === 0, bad);
  }
  check(`${where}: no message, no request elsewhere`, page.noted.length === 0, page.noted.slice(0, 5));
}

async function run() {
  await checkParts(check, root);
  build();
  const {pages, links} = checkFiles(check, site);
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [...flags, '--allow-file-access-from-files=false'],
  });
  try {
    const present = kinds.filter(path => existsSync(join(site, path)));
    check(
      'there is a page of each kind',
      present.length === kinds.length,
      kinds.filter(path => !present.includes(path)),
    );
    const views = [
      {width: 1600, dark: false, withAxe: true},
      {width: 1600, dark: true, withAxe: true},
      {width: 400, dark: false, withAxe: true},
      {width: 400, dark: true},
    ];
    // Of the other pages the manual, the theory and every tenth at the width of a phone: what is too wide shows there.
    const others = pages.filter(
      (path, i) =>
        !present.includes(path) && !path.startsWith('studio/') && (/^(theory|manual)/.test(path) || i % 10 === 0),
    );
    let looks = 0;
    await Promise.all(
      views.map(async (view, i) => {
        const paths =
          view.width === 400 && !view.dark
            ? [...present.filter((_, k) => k % 2 === 0), ...others]
            : view.dark
              ? present.filter((_, k) => k % 2 === i % 2)
              : present;
        const page = await open(browser, paths[0], {...view, reduced: true});
        for (const path of paths)
          await lookAt(page, path, {...view, withAxe: view.withAxe && present.includes(path)});
        looks += paths.length;
        await page.context().close();
      }),
    );
    await checkUse(check, browser, open, site);
    console.log(`${pages.length} pages, ${links} links, ${looks} looks, ${checks} checks`);
  } finally {
    await browser.close();
  }
}

try {
  await run();
} catch (error) {
  check('the test ran', false, error.stack ?? String(error));
}
console.log(failures === 0 ? 'all checks passed' : `${failures} checks failed`);
process.exit(failures === 0 ? 0 : 1);
