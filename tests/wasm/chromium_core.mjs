import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';
import {flags} from '../chromium.mjs';
import {project} from './requests.mjs';

const bin = project + 'build-wasm/bin/';

/** One file that holds everything, as the single-file page does: it may connect to nothing. */
function page() {
  const script = JSON.stringify(readFileSync(bin + 'maup_worker.js', 'utf8')).replaceAll('<', '\\u003c');
  return `<!doctype html><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy"
  content="default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:; connect-src 'none'">
<title>core</title><script>
const bytes = Uint8Array.from(atob("${readFileSync(bin + 'maup.wasm').toString('base64')}"), c => c.charCodeAt(0));
let worker, code, started, waiting = new Map(), messages = [], ids = 0;
function make() {
  worker = new Worker(URL.createObjectURL(new Blob([${script}], {type: 'text/javascript'})));
  started = new Promise((resolve, reject) => {
    worker.onmessage = ({data}) => {
      if (data.started) return code = data.started, resolve();
      if (data.message) return messages.push(data.message);
      if (data.failed) {
        reject(new Error(data.failed));
        for (const {reject: lose} of waiting.values()) lose(new Error(data.failed));
        return;
      }
      waiting.get(data.id).resolve(data.answer);
      waiting.delete(data.id);
    };
  });
  worker.onerror = event => { for (const {reject} of waiting.values()) reject(new Error(event.message)); };
  worker.postMessage({start: {wasm: code || bytes}});
  return started;
}
function ask(text) {
  messages = [];
  const id = ++ids;
  return new Promise((resolve, reject) => {
    waiting.set(id, {resolve, reject});
    worker.postMessage({id, request: text});
  });
}
</script>`;
}

/** The module in a worker of headless Chromium, from file://. `said`: lines of the console; `requests`: of the net. */
export class ChromiumCore {
  static async start() {
    const core = new ChromiumCore();
    core.folder = mkdtempSync(join(tmpdir(), 'maup-wasm-'));
    const file = join(core.folder, 'core.html');
    writeFileSync(file, page());
    core.browser = await chromium.launch({
      executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
      args: flags,
    });
    core.page = await core.browser.newPage();
    ((core.said = []), (core.requests = []));
    core.page.on('console', message => core.said.push(message.text()));
    core.page.on('pageerror', error => core.said.push(String(error)));
    await core.page.goto(pathToFileURL(file).href);
    core.page.on('request', request => request.url().startsWith('blob:') || core.requests.push(request.url()));
    core.ready = await core.page.evaluate(async () => {
      const begin = performance.now();
      await make();
      return performance.now() - begin;
    });
    return core;
  }
  async ask(request) {
    return JSON.parse(await this.page.evaluate(text => ask(text), JSON.stringify(request)));
  }
  /** Ends the worker in the middle of a request; a new one starts with the compiled code. ms until it is ready. */
  restart() {
    return this.page.evaluate(async () => {
      const begin = performance.now();
      worker.terminate();
      waiting.clear();
      await make();
      return performance.now() - begin;
    });
  }
  async end() {
    await this.browser.close();
    rmSync(this.folder, {recursive: true});
  }
}
