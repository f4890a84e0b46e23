// node speed.mjs node|chromium: what docs/design/web_assembly.md tells of times. It judges nothing.
import {readFileSync} from 'node:fs';
import {Native} from './native.mjs';
import {project} from './requests.mjs';

const where = process.argv[2] ?? 'node';
const core =
  where === 'chromium'
    ? await (await import('./chromium_core.mjs')).ChromiumCore.start()
    : await (await import('./node_core.mjs')).NodeCore.start();
const native = new Native();
const text = readFileSync(project + 'models/double_pendulum.lag', 'utf8');

async function best(asker, request, times) {
  let least = Infinity,
    answer;
  for (let i = 0; i < times; ++i) {
    await asker.ask({do: 'open', name: 'double_pendulum.lag', text: text + `# ${i} ${Math.random()}\n`});
    const begin = performance.now();
    answer = await asker.ask(request);
    least = Math.min(least, performance.now() - begin);
  }
  return {least, answer};
}

for (const [name, asker] of [
  ['native', native],
  [where, core],
]) {
  const equations = await best(asker, {do: 'equations', steps: false}, 10);
  const steps = await best(asker, {do: 'equations', steps: true}, 10);
  const short = await best(asker, {do: 'run', frames: 2, run: '10 s'}, 10);
  const long = await best(asker, {do: 'run', frames: 2, run: '2000 s', budget: 100}, 2);
  const of = Object.fromEntries(long.answer.statistics ?? []);
  console.log(
    `${name}: equations ${equations.least.toFixed(1)} ms, with their derivation ${steps.least.toFixed(1)} ms, ` +
      `10 s of motion ${short.least.toFixed(1)} ms, 2000 s ${long.least.toFixed(0)} ms: ${JSON.stringify(of)}`,
  );
}
native.end();
await core.end();
