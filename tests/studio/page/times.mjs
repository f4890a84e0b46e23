// What docs/design/studio.md and docs/design/web_assembly.md tell of the page's times. It judges nothing.
//   node times.mjs server MAUP PAGE      over `maup studio`
//   node times.mjs static FOLDER         from a static folder with the core as WebAssembly
import {resolve} from 'node:path';
import {fragmentOf} from '../../../site/source/studio.mjs';
import {openBrowser, serverVariant, settled, staticVariant} from './harness.mjs';

const [kind, ...folders] = process.argv.slice(2),
  variant = await (kind === 'server' ? serverVariant : staticVariant)(...folders.map(one => resolve(one))),
  browser = await openBrowser(variant);
const median = numbers => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)],
  ms = number => `${number.toFixed(1)} ms`;

function chain(links) {
  const angles = Array.from({length: links}, (_, i) => `θ${i + 1}`),
    points = angles.map((q, i) => `point P${i + 1} mass m at ${i ? `P${i} + ` : ''}l (sin ${q}, -cos ${q})`);
  return `system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord ${angles.join(', ')} : angle
${points.join('\n')}\ngravity (0, -g)\nstart ${angles.map(q => `${q} = 1 rad`).join(', ')}\nrun 10 s
draw O - ${angles.map((_, i) => `P${i + 1}`).join(' - ')}\n`;
}

/** From the address to what is seen first, and to equations and a motion. */
async function opening() {
  const page = await browser.open({hash: '#example=double_pendulum'}),
    times = await page.evaluate(() => ({
      paint: performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN,
      settled: performance.now(),
    }));
  console.log(`first paint ${ms(times.paint)}, equations and motion before ${ms(times.settled)}`);
  return page;
}

/** From a sign that is typed to the equations that follow from it. */
async function keystrokes(page, times) {
  const taken = [];
  for (let i = 0; i < times; ++i) {
    taken.push(
      await page.evaluate(async () => {
        const content = document.querySelector('.cm-content'),
          view = content.cmTile?.view ?? content.cmView?.view,
          text = view.state.doc.toString(),
          doubled = text.indexOf('(0, -2 g)'),
          at = (doubled < 0 ? text.indexOf('(0, -g)') : doubled) + 5;
        const shown = document.querySelector('#equations-body'),
          before = shown.textContent;
        const fresh = new Promise(done => {
          const watcher = new MutationObserver(() => {
            if (shown.textContent === before || !shown.querySelector('math')) return;
            watcher.disconnect();
            done(performance.now());
          });
          watcher.observe(shown, {childList: true, subtree: true, characterData: true});
        });
        const begin = performance.now();
        view.dispatch({changes: doubled < 0 ? {from: at, insert: '2 '} : {from: at, to: at + 2}});
        return (await fresh) - begin;
      }),
    );
    await settled(page);
  }
  const all = taken.slice().sort((a, b) => a - b);
  console.log(`a sign to fresh equations: ${ms(median(all))} (${all.map(one => one.toFixed(0)).join(' ')})`);
}

/** Twenty links in motion while the slider of their length moves at each frame. */
async function frames(seconds) {
  const page = await browser.open({hash: `#${fragmentOf(chain(20), 'chain')}`, still: false}),
    devtools = await page.context().newCDPSession(page);
  await devtools.send('Performance.enable', {timeDomain: 'threadTicks'});
  const spent = async () =>
    Object.fromEntries((await devtools.send('Performance.getMetrics')).metrics.map(one => [one.name, one.value]));
  const before = await spent();
  const count = await page.evaluate(async seconds => {
    const slider = document.querySelector('.value[data-name="l"] input[type=range]'),
      begin = performance.now();
    let count = 0;
    await new Promise(done =>
      requestAnimationFrame(function step(now) {
        ++count;
        slider.value = String(1 + 0.4 * Math.sin(now / 300));
        slider.dispatchEvent(new Event('input'));
        if (now - begin < 1000 * seconds) requestAnimationFrame(step);
        else done();
      }),
    );
    return count;
  }, seconds);
  const after = await spent(),
    each = name => ms((1000 * (after[name] - before[name])) / count);
  console.log(
    `20 links while a slider moves: ${(count / seconds).toFixed(0)} frames a second; of a frame scripts have ` +
      `${each('ScriptDuration')}, layout ${each('LayoutDuration')}, styles ${each('RecalcStyleDuration')}, ` +
      `all tasks of the page's thread ${each('TaskDuration')} (processor time)`,
  );
  await page.context().close();
}

try {
  const page = await opening();
  await keystrokes(page, 15);
  await page.context().close();
  for (let i = 0; i < 3; ++i) await frames(3);
} finally {
  await browser.end();
  variant.end();
}
