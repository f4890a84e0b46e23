// Opens reports in a real headless Chromium, over the DevTools protocol on its pipe, and uses them as a reader would.
//   node browser.mjs WRITER [REPORT.html ...]
// WRITER (report_browser_page) makes two reports of made-up numbers; further reports get the checks that hold for any.
// Fails on any error that the browser reports, on any request, and when there is no Chromium: nothing is skipped.
import {spawn, spawnSync} from 'node:child_process';
import {mkdtempSync, rmSync, existsSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {flags} from '../../chromium.mjs';

const [writer, ...others] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'maup-browser-'));
let failures = 0;

function check(what, holds, detail = '') {
  if (holds) return;
  ++failures;
  const told = typeof detail === 'string' ? detail : JSON.stringify(detail);
  console.error(`FAILED: ${what}${detail === '' ? '' : `: ${told}`}`);
}

// ------------------------------------------------------------------------------------------------------------ browser

function findChromium() {
  const named = process.env.CHROMIUM ? [process.env.CHROMIUM] : [];
  for (const name of [...named, 'chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable'])
    if (spawnSync(name, ['--version'], {stdio: 'ignore'}).status === 0) return name;
  throw new Error('there is no Chromium; on Debian: apt install chromium');
}

class Browser {
  constructor() {
    const own = ['--headless', '--mute-audio', '--remote-debugging-pipe', `--user-data-dir=${join(folder, 'profile')}`];
    this.process = spawn(findChromium(), [...flags, ...own, 'about:blank'],
                         {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    this.next = 1;
    this.waiting = new Map();
    this.listeners = [];
    this.exited = new Promise(done => this.process.on('exit', done));
    let rest = '';
    this.process.stdio[4].setEncoding('utf8').on('data', text => {
      const messages = (rest + text).split('\0');
      rest = messages.pop();
      for (const message of messages) this.receive(JSON.parse(message));
    });
  }

  receive(message) {
    if (!message.id) return this.listeners.forEach(listener => listener(message));
    const {done, failed} = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) failed(new Error(message.error.message)); else done(message.result);
  }

  send(method, params = {}, sessionId) {
    const id = this.next++;
    this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + '\0');
    return new Promise((done, failed) => this.waiting.set(id, {done, failed}));
  }

  async close() {
    this.send('Browser.close').catch(() => {});
    const timer = setTimeout(() => this.process.kill('SIGKILL'), 5000);
    await this.exited;
    clearTimeout(timer);
  }
}

// One page: what it complains of, what it asks for, and hands to use it.
class Page {
  static async open(browser, file, {width = 1200, height = 900, dark = false} = {}) {
    const page = new Page();
    page.url = pathToFileURL(resolve(file)).href;
    page.errors = [];
    page.requests = [];
    const {targetId} = await browser.send('Target.createTarget', {url: 'about:blank'});
    const {sessionId} = await browser.send('Target.attachToTarget', {targetId, flatten: true});
    page.send = (method, params) => browser.send(method, params, sessionId);
    page.close = () => browser.send('Target.closeTarget', {targetId});
    const loaded = new Promise(done => browser.listeners.push(message => {
      if (message.sessionId !== sessionId) return;
      page.note(message);
      if (message.method === 'Page.loadEventFired') done();
    }));
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await page.send(`${domain}.enable`);
    await page.send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: 1, mobile: false});
    const features = [{name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'}];
    await page.send('Emulation.setEmulatedMedia', {features});
    await page.send('Page.navigate', {url: page.url});
    await loaded;
    await page.frames(3);
    return page;
  }

  note({method, params}) {
    if (method === 'Runtime.exceptionThrown') {
      const details = params.exceptionDetails;
      this.errors.push(details.exception?.description ?? details.text);
    }
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning', 'assert'].includes(params.type))
      this.errors.push(params.args.map(a => a.value ?? a.description).join(' '));
    if (method === 'Log.entryAdded' && params.entry.level !== 'verbose') this.errors.push(params.entry.text);
    const own = params.request?.url === this.url;
    if (method === 'Network.requestWillBeSent' && !own && !params.request.url.startsWith('data:'))
      this.requests.push(params.request.url);
  }

  async evaluate(expression) {
    const asked = {expression, returnByValue: true, awaitPromise: true};
    const {result, exceptionDetails} = await this.send('Runtime.evaluate', asked);
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  frames(count) {
    return this.evaluate(`new Promise(done => {
      let n = ${count};
      const next = () => n-- ? requestAnimationFrame(next) : done(true);
      next();
    })`);
  }

  async key(key, target = 'document.activeElement') {
    const event = `new KeyboardEvent('keydown', {key: ${JSON.stringify(key)}, bubbles: true, cancelable: true})`;
    await this.evaluate(`${target}.dispatchEvent(${event})`);
  }

  // What is on the canvas, as a number.
  picture() {
    return this.evaluate(`(() => {
      let hash = 0;
      for (const c of document.querySelector('#animation canvas').toDataURL()) hash = (hash * 31 + c.charCodeAt(0)) | 0;
      return hash;
    })()`);
  }
  time() { return this.evaluate(`Number(document.getElementById('animation').dataset.time)`); }
  state() { return this.evaluate(`document.getElementById('animation').dataset.state`); }
  pause(milliseconds) { return new Promise(done => setTimeout(done, milliseconds)); }
}

// ------------------------------------------------------------------------------------------------------------- checks

async function checkAnyReport(browser, name, file) {
  const page = await Page.open(browser, file);
  const all = formulas => page.evaluate(`document.querySelectorAll('${formulas}').length`);
  check(`${name}: has equations in MathML`, await all('#equations math') > 0);
  const laidOut = await page.evaluate(
    `[...document.querySelectorAll('#equations math')].every(m => m.getBoundingClientRect().height > 5)`);
  check(`${name}: MathML is laid out`, laidOut);
  const namespaces = await page.evaluate(
    `[...document.querySelectorAll('math *')].every(e => e.namespaceURI === 'http://www.w3.org/1998/Math/MathML')`);
  check(`${name}: every element of a formula is MathML`, namespaces);
  check(`${name}: nothing is fetched`, page.requests.length === 0, page.requests);
  check(`${name}: no errors`, page.errors.length === 0, page.errors);
  for (const width of [1200, 390]) {
    await page.send('Emulation.setDeviceMetricsOverride', {width, height: 900, deviceScaleFactor: 1, mobile: false});
    await page.frames(2);
    const overflow = await page.evaluate(`document.documentElement.scrollWidth - innerWidth`);
    check(`${name}: fits a window of ${width} px`, overflow <= 0, overflow);
  }
  await page.close();
}

async function checkAnimation(browser, name, file) {
  const page = await Page.open(browser, file);
  const first = await page.picture();
  const begins = await page.state() === 'paused' && await page.time() === 0;
  check(`${name}: begins paused at the start`, begins, await page.time());

  // Play: the clock runs and the picture moves; pause: both stand still.
  await page.evaluate(`document.querySelector('[data-control=play]').click()`);
  await page.pause(400);
  check(`${name}: plays`, await page.state() === 'playing');
  const during = await page.time();
  check(`${name}: time goes on while playing`, during > 0.05, during);
  await page.evaluate(`document.querySelector('[data-control=play]').click()`);
  const [stopped, picture] = [await page.time(), await page.picture()];
  await page.pause(250);
  check(`${name}: pause stops the time`, await page.state() === 'paused' && await page.time() === stopped);
  check(`${name}: pause stops the picture`, await page.picture() === picture);
  check(`${name}: the picture moved`, picture !== first);

  // Scrub to the middle; back to the start gives the first picture again.
  const scrub = value => page.evaluate(`(() => {
    const s = document.querySelector('[data-control=scrub]');
    s.value = ${value};
    s.dispatchEvent(new Event('input'));
  })()`);
  await scrub(0.5);
  check(`${name}: scrubbing sets the time`, Math.abs(await page.time() - 4) < 1e-9, await page.time());
  const shown = await page.evaluate(`document.querySelector('[data-control=time]').textContent`);
  check(`${name}: the time is shown`, shown === '4.000 s');
  check(`${name}: scrubbing moves the picture`, await page.picture() !== picture);
  await scrub(0);
  check(`${name}: the same time gives the same picture`, await page.picture() === first);

  // Keys.
  await page.key('ArrowRight', 'document.body');
  check(`${name}: the right arrow steps on`, Math.abs(await page.time() - 0.04) < 1e-9, await page.time());
  await page.key('ArrowLeft', 'document.body');
  check(`${name}: the left arrow steps back`, await page.time() === 0);
  await page.key(' ', 'document.body');
  check(`${name}: the space bar plays`, await page.state() === 'playing');
  await page.key(' ', 'document.body');
  check(`${name}: the space bar pauses`, await page.state() === 'paused');

  // A faster clock gets farther: 5 times the speed, at least 2 times as far in the same time.
  const distance = async index => {
    await scrub(0);
    await page.evaluate(`document.querySelector('[data-control=speed]').selectedIndex = ${index}`);
    await page.evaluate(`document.querySelector('[data-control=play]').click()`);
    await page.pause(300);
    await page.evaluate(`document.querySelector('[data-control=play]').click()`);
    return page.time();
  };
  const [slow, fast] = [await distance(3), await distance(5)];
  check(`${name}: speed changes the pace`, fast > 2 * slow, [slow, fast]);

  // The end stops the clock; playing again begins anew.
  await scrub(0.999);
  await page.key(' ', 'document.body');
  await page.pause(300);
  const ends = await page.state() === 'paused' && Math.abs(await page.time() - 8) < 1e-9;
  check(`${name}: stops at the end`, ends, await page.time());

  // Light and dark.
  const paper = () => page.evaluate(`getComputedStyle(document.body).backgroundColor`);
  const light = await paper();
  await page.evaluate(`document.getElementById('theme').click()`);
  check(`${name}: the button changes light to dark`, await paper() !== light);
  check(`${name}: no errors in use`, page.errors.length === 0, page.errors);
  await page.close();
}

async function checkTurning(browser, file) {
  const page = await Page.open(browser, file);
  const before = await page.picture();
  const drag = (type, x, y) => page.evaluate(`(() => {
    const c = document.querySelector('#animation canvas'), r = c.getBoundingClientRect();
    c.setPointerCapture = () => {};
    const at = {clientX: r.left + ${x}, clientY: r.top + ${y}, pointerId: 1, bubbles: true};
    c.dispatchEvent(new PointerEvent('${type}', at));
  })()`);
  await drag('pointerdown', 100, 100);
  await drag('pointermove', 180, 130);
  await drag('pointerup', 180, 130);
  const turned = await page.picture();
  check('space: dragging turns the view', turned !== before);
  await drag('pointermove', 10, 10);
  check('space: the view rests after the drag', await page.picture() === turned);
  check('space: no errors in turning', page.errors.length === 0, page.errors);
  await page.close();
}

async function checkText(browser, file) {
  const page = await Page.open(browser, file, {dark: true});
  const text = selector => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).textContent`);
  check('the title is text, not markup', await text('h1') === 'Spherical pendulum <3-D> & friends', await text('h1'));
  check('the model text is text, not markup', (await text('pre.model')).includes('</script><b>masses</b>'));
  const comment = await text('pre.model .comment');
  check('a comment begins at its own #', comment === '# </script><b>masses</b>', comment);
  check('plots are drawn', await page.evaluate(`document.querySelectorAll('svg.maup-plot path.curve').length`) >= 6);
  const curve = await page.evaluate(`getComputedStyle(document.querySelector('svg.maup-plot .s1')).stroke`);
  check('plots take their colours from the page', curve === 'rgb(90, 180, 236)', curve);
  const features = [{name: 'prefers-color-scheme', value: 'dark'}];
  await page.send('Emulation.setEmulatedMedia', {media: 'print', features});
  const paper = await page.evaluate(`getComputedStyle(document.documentElement).getPropertyValue('--ink').trim()`);
  check('on paper the ink is dark', paper === '#1d1b18', paper);
  const controls = await page.evaluate(`getComputedStyle(document.querySelector('.controls')).display`);
  check('on paper there are no controls', controls === 'none');
  await page.close();
}

// The test must be able to fail: a page that logs an error and one that asks for a file are caught.
async function checkTheChecks(browser) {
  const {writeFileSync} = await import('node:fs');
  const file = join(folder, 'bad.html');
  const wrong = '<script>console.error("an error"); undefinedFunction();</script><img src="missing.png">';
  writeFileSync(file, `<!DOCTYPE html>${wrong}`);
  const page = await Page.open(browser, file);
  const errors = page.errors.filter(e => /an error|undefinedFunction/.test(e));
  check('an exception and a logged error are seen', errors.length >= 2, page.errors);
  check('a request is seen', page.requests.some(url => url.endsWith('missing.png')), page.requests);
  await page.close();
}

async function run() {
  const made = {};
  for (const name of ['plane', 'space']) {
    made[name] = join(folder, `${name}.html`);
    if (spawnSync(writer, [name, made[name]], {stdio: 'inherit'}).status !== 0) throw new Error(`${writer} failed`);
  }
  const browser = new Browser();
  const deadline = setTimeout(() => {
    console.error('FAILED: no end within 120 s');
    browser.process.kill('SIGKILL');
    process.exit(1);
  }, 120_000);
  try {
    await checkTheChecks(browser);
    for (const [name, file] of Object.entries(made)) {
      await checkAnyReport(browser, name, file);
      await checkAnimation(browser, name, file);
    }
    await checkTurning(browser, made.space);
    await checkText(browser, made.space);
    for (const file of others) {
      if (!existsSync(file)) check(`${file} exists`, false);
      else await checkAnyReport(browser, file, file);
    }
  } finally {
    clearTimeout(deadline);
    await browser.close();
  }
}

try {
  await run();
} catch (error) {
  check('the test ran', false, error.stack ?? String(error));
} finally {
  rmSync(folder, {recursive: true, force: true, maxRetries: 5});
}
console.log(failures === 0 ? 'all checks passed' : `${failures} checks failed`);
process.exit(failures === 0 ? 0 : 1);
