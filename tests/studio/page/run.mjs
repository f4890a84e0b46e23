// The studio in a real Chromium.
//   node run.mjs server MAUP PAGE [CASE…]      over `maup studio`
//   node run.mjs static FOLDER [CASE…]         from a static folder with the core as WebAssembly
// STUDIO_PICTURES names a folder for screenshots.
import {resolve} from 'node:path';
import {answers} from './answers.mjs';
import {carriers} from './carriers.mjs';
import {cases} from './cases.mjs';
import {check, checks, failures, openBrowser, pictures, serverVariant, staticVariant} from './harness.mjs';
import {kinds} from './kinds.mjs';
import {lessons} from './lessons.mjs';
import {texts} from './texts.mjs';

const [kind, ...words] = process.argv.slice(2);
const variant =
  kind === 'server'
    ? await serverVariant(resolve(words[0]), resolve(words[1]))
    : await staticVariant(resolve(words[0]));
const wanted = words.slice(kind === 'server' ? 2 : 1),
  picture = pictures(process.env.STUDIO_PICTURES);
const browser = await openBrowser(variant);
try {
  for (const [name, run] of Object.entries({...cases, ...texts, ...answers, ...carriers, ...kinds, ...lessons})) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    const begin = Date.now(),
      before = failures;
    await run(browser, variant, picture).catch(error => check(name, false, error.stack));
    console.log(`${failures === before ? 'ok    ' : 'FAILED'} ${name} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
  }
} finally {
  await browser.end();
  variant.end();
}
console.log(`${checks - failures} passed, ${failures} failed`);
process.exit(failures === 0 && checks > 0 ? 0 : 1);
