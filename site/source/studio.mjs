// The studio within the site: its page with the core as WebAssembly beside it, and addresses that open a model in it.
import {cpSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {deflateRawSync, inflateRawSync} from 'node:zlib';

// The fragment, which no server sees: {text, name} as JSON, deflated, in base64url (read by studio/src/tools/share.ts).
export const fragmentOf = (text, name) =>
  `m=${deflateRawSync(Buffer.from(JSON.stringify({text, name}), 'utf8'), {level: 9}).toString('base64url')}`;

export const textOfFragment = fragment =>
  JSON.parse(inflateRawSync(Buffer.from(fragment.replace(/^#?m=/, ''), 'base64url')).toString('utf8')).text;

/// What keeps the studio out of the site, or null: the page is of scripts/studio, the core of scripts/wasm.
export function missingOf(page, core) {
  if (!existsSync(join(page, 'index.html'))) return `no page of the studio in ${page} (make studio)`;
  if (!existsSync(join(core, 'maup_worker.js'))) return `no core for a browser in ${core} (make wasm)`;
  return null;
}

// A page from a file may neither fetch nor start a worker from a file: there the core comes as a script.
const choose = `'use strict';
if (location.protocol === 'file:') document.write('<script src="core_in_a_script.js"><\\/script>');
else document.documentElement.dataset.core = 'maup_worker.js';
`;

// The worker begins by itself with the module (its first message may bring one, apps/studio_wasm/worker.js).
const inScript = (worker, wasm) => `'use strict';
{
  const worker = ${JSON.stringify(worker)};
  const bytes = 'Uint8Array.from(atob("${wasm}"), c => c.charCodeAt(0))';
  const begin = '\\nself.onmessage({data: {start: {wasm: ' + bytes + '}}});\\n';
  document.documentElement.dataset.core = URL.createObjectURL(new Blob([worker, begin], {type: 'text/javascript'}));
}
`;

export function copyStudio(page, core, to) {
  mkdirSync(to, {recursive: true});
  for (const name of readdirSync(page).filter(name => !/^page\.(html|policy)|^index\.html$/.test(name)))
    cpSync(join(page, name), join(to, name), {recursive: true});
  for (const name of ['maup_worker.js', 'maup.wasm']) cpSync(join(core, name), join(to, name));
  const html = readFileSync(join(page, 'index.html'), 'utf8'),
    begin = html.indexOf('<script');
  if (begin < 0) throw new Error(`${page}/index.html has no script`);
  writeFileSync(
    join(to, 'index.html'),
    `${html.slice(0, begin)}<script src="core.js"></script>\n${html.slice(begin)}`,
  );
  writeFileSync(join(to, 'core.js'), choose);
  const wasm = readFileSync(join(core, 'maup.wasm')).toString('base64');
  writeFileSync(join(to, 'core_in_a_script.js'), inScript(readFileSync(join(core, 'maup_worker.js'), 'utf8'), wasm));
}
