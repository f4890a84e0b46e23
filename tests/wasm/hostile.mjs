// node hostile.mjs: requests that go wrong, in a worker of Chromium. It has to live, say why, and answer the next.
import {readFileSync} from 'node:fs';
import {gzipSync} from 'node:zlib';
import {ChromiumCore} from './chromium_core.mjs';
import {project} from './requests.mjs';

const double_pendulum = readFileSync(project + 'models/double_pendulum.lag', 'utf8');
const core = await ChromiumCore.start();
let failed = 0;

function expect(name, holds, what) {
  if (!holds) ((failed += 1), console.log(`${name}: ${JSON.stringify(what).slice(0, 400)}`));
}

/** Afterwards the same session opens a model and derives its equations. */
async function lives(name) {
  await core.ask({do: 'open', name: 'double_pendulum.lag', text: double_pendulum});
  const answer = await core.ask({do: 'equations'});
  expect(`${name}, afterwards`, answer.ok && answer.certified, answer);
}

async function open(text) {
  return core.ask({do: 'open', name: 'model.lag', text});
}
const oscillator = (start = 'x = 1 m', run = '1 s') => `system spring
param m = 1 kg, k = 4 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start ${start}
run ${run}
`;

const cases = {
  async 'no JSON'() {
    for (const text of ['', '{', '[]', '{"do": 5}', '{"do": "dance"}', '\u0000']) {
      const answer = JSON.parse(await core.page.evaluate(t => ask(t), text));
      expect('no JSON', !answer.ok && answer.kind === 'request', answer);
    }
  },
  async 'ten megabytes'() {
    const answer = await open('# ' + 'x'.repeat(10_000_000));
    expect('ten megabytes', !answer.ok && answer.kind === 'refused', answer);
  },
  async 'a million bytes of statements'() {
    const answer = await open('param a = 1\n'.repeat(80_000));
    expect('a million bytes', answer.ok && answer.diagnostics.length > 0, answer);
  },
  async 'a tower of parentheses'() {
    for (const depth of [100, 10_000, 400_000]) {
      const answer = await open(oscillator() + `let y = ${'('.repeat(depth)}1${')'.repeat(depth)}\n`);
      expect(`${depth} parentheses`, answer.ok, answer);
      await core.ask({do: 'equations', budget: 5});
    }
  },
  async 'a tower of minus signs and functions'() {
    const answer = await open(oscillator() + `let y = ${'-'.repeat(300_000)}1\nlet z = ${'sin '.repeat(150_000)}x\n`);
    expect('minus signs', answer.ok, answer);
    await core.ask({do: 'equations', budget: 5});
  },
  async 'a start that is no number'() {
    await open(oscillator('x = 0 m / 0'));
    const answer = await core.ask({do: 'run'});
    expect('0/0', !answer.ok && answer.kind === 'model', answer);
  },
  async 'a run without end'() {
    await open(oscillator('x = 1 m', '1e12 s'));
    const begin = performance.now(),
      answer = await core.ask({do: 'run', budget: 1, frames: 10}),
      seconds = (performance.now() - begin) / 1000;
    expect('a run without end', seconds < 5 && (answer.ok ? !answer.ending.ok : answer.kind === 'budget'), [
      seconds,
      answer,
    ]);
  },
  async 'a derivation without end'() {
    const links = [...Array(60).keys()].map(i => `θ${i + 1}`);
    const points = links.map((q, i) => `point P${i + 1} mass m at ${i ? `P${i} + ` : ''}l (sin ${q}, -cos ${q})`);
    await open(
      `system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\n` +
        `coord ${links.join(', ')} : angle\n${points.join('\n')}\n` +
        `gravity (0, -g)\nstart ${links.map(q => `${q} = 2 rad`).join(', ')}\nrun 1 s\n`,
    );
    const begin = performance.now(),
      answer = await core.ask({do: 'equations', steps: true, budget: 0.5}),
      seconds = (performance.now() - begin) / 1000;
    expect('a derivation without end', seconds < 3 && !answer.ok && answer.kind === 'budget', [seconds, answer.kind]);
  },
  async 'a worker that is ended'() {
    await open(oscillator('x = 1 m', '1e12 s'));
    core.page.evaluate(() => {
      ask(JSON.stringify({do: 'run', budget: 600})).catch(() => {});
    });
    await new Promise(resolve => setTimeout(resolve, 300));
    console.log(`a worker that was ended: the next is ready after ${(await core.restart()).toFixed(0)} ms`);
  },
};

for (const [name, run] of Object.entries(cases)) {
  try {
    await run();
    await lives(name);
  } catch (error) {
    failed += 1;
    console.log(`${name}: the worker failed: ${String(error).slice(0, 300)}`);
    await core.restart();
  }
}
const bytes = name => gzipSync(readFileSync(`${project}build-wasm/bin/${name}`), {level: 9}).length;
const size = bytes('maup.wasm') + bytes('maup_worker.js');
expect('size', size < 2_780_000, size); // of 3 MB, of which the page has 0.22
for (const text of core.said) expect('the console', false, text);
expect('the network', core.requests.length === 0, core.requests);
console.log(
  `${Object.keys(cases).length} kinds of bad input, ${failed} failures; ` +
    `first ready after ${core.ready.toFixed(0)} ms; ` +
    `${(size / 1e6).toFixed(2)} MB gzip`,
);
await core.end();
process.exitCode = failed ? 1 : 0;
