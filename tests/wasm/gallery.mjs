// node gallery.mjs node|chromium [part of a name]: all models by the module and by the session of this machine.
import {Native} from './native.mjs';
import {compare, models, requestsFor} from './requests.mjs';

const [where = 'node', only = ''] = process.argv.slice(2);
const core =
  where === 'chromium'
    ? await (await import('./chromium_core.mjs')).ChromiumCore.start()
    : await (await import('./node_core.mjs')).NodeCore.start();
const native = new Native();
let lines = 0,
  wrong = 0;
const seconds = {native: 0, wasm: 0};

async function timed(who, answering) {
  const begin = performance.now();
  const answer = await answering;
  seconds[who] += (performance.now() - begin) / 1000;
  return answer;
}

for (const model of models(only)) {
  for (const request of requestsFor(model)) {
    const here = await timed('native', native.ask(request));
    const there = await timed('wasm', core.ask(request));
    const found = compare(model, request, here, there);
    if (request.do === 'expectations' && here.ok) lines += here.results.length;
    wrong += found.length;
    for (const text of found.slice(0, 5)) console.log(`${model}, ${request.do}: ${text}`);
  }
}
if (where === 'chromium') {
  for (const text of core.said) console.log(`console: ${text}`);
  for (const address of core.requests) console.log(`a request after the page was loaded: ${address}`);
  wrong += core.said.length + core.requests.length;
  console.log(`ready after ${core.ready.toFixed(0)} ms`);
}
console.log(
  `${where}: ${models(only).length} models, ${lines} lines of expectations, ${wrong} differences; ` +
    `${seconds.wasm.toFixed(1)} s, the session of this machine ${seconds.native.toFixed(1)} s`,
);
native.end();
await core.end();
process.exitCode = wrong === 0 && lines > 0 ? 0 : 1;
