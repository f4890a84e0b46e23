// A Chromium with the page of the studio in it, over the local server or from a static folder; and what every test
// checks.
import {AsyncLocalStorage} from 'node:async_hooks';
import {spawn} from 'node:child_process';
import {cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, existsSync, statSync} from 'node:fs';
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {extname, join, resolve} from 'node:path';
import {flags} from '../../chromium.mjs';

export const root = resolve(import.meta.dirname, '../../..');
const require = createRequire(join(root, 'studio/package.json'));
const {chromium} = require('playwright-core');
const axeSource = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

export let failures = 0,
  checks = 0;
const here = new AsyncLocalStorage(); // the case that runs: several do at a time
export function check(what, good, detail = '') {
  ++checks;
  if (good) return;
  ++failures;
  const within = here.getStore();
  if (within) ++within.failures;
  console.error(`FAILED: ${within ? `${within.name}: ` : ''}${what}`, detail);
}

/** How many checks fail in it. */
export async function inCase(name, run) {
  const within = {name, failures: 0};
  await here.run(within, run);
  return within.failures;
}

/** `maup studio` over a folder of its own; `address()` is good once, as its token is. */
export async function serverVariant(maup, page) {
  const folder = mkdtempSync(join(tmpdir(), 'maup-studio-'));
  for (const name of ['pendulum', 'double_pendulum', 'four_bar'])
    cpSync(join(root, `models/${name}.lag`), join(folder, `${name}.lag`));
  const process_ = spawn(maup, ['studio', folder, '--no-browser', '--json', '--page', page], {
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  const told = await new Promise((done, broken) => {
    let text = '';
    process_.stdout.on('data', data => {
      text += data;
      if (text.includes('\n')) done(JSON.parse(text.split('\n')[0]));
    });
    process_.on('exit', code => broken(new Error(`maup studio ended with ${code}: ${text}`)));
  });
  const base = new URL('/', told.address).href;
  return {
    name: 'server',
    base,
    entry: told.address,
    folder,
    slow: 1,
    end: () => {
      process_.kill('SIGINT');
      rmSync(folder, {recursive: true, force: true});
    },
  };
}

/** A static folder, as any host would give it. */
export async function staticVariant(folder) {
  const types = {
    '.html': 'text/html; charset=utf-8',
    '.js': 'text/javascript',
    '.css': 'text/css',
    '.wasm': 'application/wasm',
    '.svg': 'image/svg+xml',
  };
  const server = createServer((request, response) => {
    const path = join(folder, decodeURIComponent(new URL(request.url, 'http://x').pathname));
    const file = existsSync(path) && statSync(path).isDirectory() ? join(path, 'index.html') : path;
    if (!file.startsWith(folder) || !existsSync(file)) {
      response.statusCode = 404;
      return response.end();
    }
    response.setHeader('Content-Type', types[extname(file)] ?? 'application/octet-stream');
    response.end(readFileSync(file));
  });
  await new Promise(done => server.listen(0, '127.0.0.1', done));
  const base = `http://127.0.0.1:${server.address().port}/`;
  return {name: 'static', files: folder, base, entry: base, folder: null, slow: 3, end: () => server.close()};
}

/** Pages of one browser; what the console says, and every request that leaves the page's own server, is a failure. */
export async function openBrowser(variant) {
  const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: flags});
  let cookies = null;

  async function open({
    width = 1600,
    height = 900,
    dark = false,
    hash = '',
    still = true,
    wait = true,
    storage = true,
    touch = false,
    allow = [],
    url = null,
    before = () => {},
  } = {}) {
    const context = await browser.newContext({
      viewport: {width, height},
      colorScheme: dark ? 'dark' : 'light',
      reducedMotion: still ? 'reduce' : 'no-preference',
      hasTouch: touch,
      isMobile: touch,
      permissions: ['clipboard-read', 'clipboard-write'],
      acceptDownloads: true,
    });
    context.setDefaultTimeout(120_000); // what does not come at all: a machine may be busy
    const page = await context.newPage(),
      checkHere = AsyncLocalStorage.bind(check); // events are told outside of the case
    page.on('console', message =>
      checkHere(
        'nothing is said on the console',
        allow.some(one => message.text().includes(one)),
        message.text(),
      ),
    );
    page.on('pageerror', error => checkHere('no error escapes', false, error.stack));
    page.on('request', request =>
      checkHere(
        'no request leaves the page',
        /^(data|blob):/.test(request.url()) || request.url().startsWith(url ?? variant.base),
        request.url(),
      ),
    );
    if (!storage)
      await page.addInitScript(() =>
        Object.defineProperty(window, 'localStorage', {
          get() {
            throw new DOMException('no storage', 'SecurityError');
          },
        }),
      );
    await before(page);
    if (cookies) await context.addCookies(cookies);
    await page.goto(url ? url + hash : cookies || variant.name === 'static' ? variant.base + hash : variant.entry);
    if (!url && !cookies && variant.name === 'server') {
      cookies = await context.cookies();
      if (hash) {
        await page.goto('about:blank');
        await page.goto(variant.base + hash);
      }
    }
    if (wait) await settled(page);
    return page;
  }
  return {open, end: () => browser.close()};
}

/** Equations and a full run of the text are there, and nothing is asked any more. */
export async function settled(page) {
  await page.waitForFunction(
    () =>
      document.querySelector('#equations-body math') &&
      document.querySelector('#time').textContent &&
      document.body.dataset.settled === 'true',
    null,
    {timeout: 60_000},
  );
}

/**
 * Where the point is that can be dragged and is next to this part of the canvas: the pointer becomes a hand over it.
 */
export async function gripNear(page, name, part = [0.5, 0.5]) {
  return page.locator(name).evaluate((canvas, wanted) => {
    const box = canvas.getBoundingClientRect(),
      grips = [];
    for (let y = 4; y < box.height; y += 5)
      for (let x = 4; x < box.width; x += 5) {
        canvas.dispatchEvent(
          new PointerEvent('pointermove', {clientX: box.left + x, clientY: box.top + y, pointerId: 99}),
        );
        if (canvas.style.cursor === 'grab') grips.push([x, y]);
      }
    const away = ([x, y]) => Math.hypot(x / box.width - wanted[0], y / box.height - wanted[1]);
    const best = grips.sort((a, b) => away(a) - away(b))[0];
    if (!best) return null;
    const near = grips.filter(([x, y]) => Math.hypot(x - best[0], y - best[1]) < 40),
      mean = k => near.reduce((sum, one) => sum + one[k], 0) / near.length;
    return [box.left + mean(0), box.top + mean(1)];
  }, part);
}

export async function axe(page, what) {
  await page.evaluate(axeSource);
  const found = await page.evaluate(async () =>
    (await window.axe.run(document, {resultTypes: ['violations']})).violations
      .filter(v => v.impact === 'serious' || v.impact === 'critical')
      .map(
        v =>
          `${v.id}: ${v.help} – ${v.nodes
            .slice(0, 3)
            .map(n => n.html.slice(0, 160))
            .join(' | ')}`,
      ),
  );
  check(`axe has nothing serious to say of ${what}`, found.length === 0, found.join('\n'));
}

export function pictures(folder) {
  if (folder) mkdirSync(folder, {recursive: true});
  return async (page, name) => {
    if (folder) await page.screenshot({path: join(folder, `${name}.png`)});
  };
}
