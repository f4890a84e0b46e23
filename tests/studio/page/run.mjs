// The studio in a real Chromium.
//   node run.mjs server MAUP PAGE [CASE…]      over `maup studio`
//   node run.mjs static FOLDER [CASE…]         from a static folder with the core as WebAssembly
// STUDIO_PICTURES names a folder for screenshots. Cases wait for most of their time, for a person who types or for what
// the page does after a while: STUDIO_BROWSERS of them (2) run at a time, each with a server and a browser of its own.
import {resolve} from 'node:path';
import {answers} from './answers.mjs';
import {carriers} from './carriers.mjs';
import {cases} from './cases.mjs';
import {check, checks, failures, inCase, openBrowser, pictures, serverVariant, staticVariant} from './harness.mjs';
import {kinds} from './kinds.mjs';
import {lessons} from './lessons.mjs';
import {texts} from './texts.mjs';

const [kind, ...words] = process.argv.slice(2);
const wanted = words.slice(kind === 'server' ? 2 : 1),
  picture = pictures(process.env.STUDIO_PICTURES),
  all = Object.entries({...cases, ...texts, ...answers, ...carriers, ...kinds, ...lessons}),
  left = all.filter(([name]) => wanted.length === 0 || wanted.includes(name)),
  browsers = Math.min(Number(process.env.STUDIO_BROWSERS ?? 2), left.length);

async function one(name, run, browser, variant) {
  const begin = Date.now();
  const failed = await inCase(name, () =>
    run(browser, variant, picture).catch(error => check(name, false, error.stack)),
  );
  console.log(`${failed === 0 ? 'ok    ' : 'FAILED'} ${name} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
}

/** Cases one after the other, until none is left. */
async function work() {
  const variant =
    kind === 'server'
      ? await serverVariant(resolve(words[0]), resolve(words[1]))
      : await staticVariant(resolve(words[0]));
  try {
    const browser = await openBrowser(variant);
    try {
      for (let next = left.shift(); next; next = left.shift()) await one(...next, browser, variant);
    } finally {
      await browser.end();
    }
  } finally {
    variant.end();
  }
}

await Promise.all(Array.from({length: browsers}, work));
console.log(`${checks - failures} passed, ${failures} failed`);
process.exit(failures === 0 && checks > 0 ? 0 : 1);
