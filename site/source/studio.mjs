// The studio within the site, and the addresses that open a model in it.
import {cpSync, existsSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {deflateRawSync, inflateRawSync} from 'node:zlib';

// The fragment, which no server sees: {text, name} as JSON, deflated, in base64url (read by studio/src/tools/share.ts).
export const fragmentOf = (text, name) =>
  `m=${deflateRawSync(Buffer.from(JSON.stringify({text, name}), 'utf8'), {level: 9}).toString('base64url')}`;

export const textOfFragment = fragment =>
  JSON.parse(inflateRawSync(Buffer.from(fragment.replace(/^#?m=/, ''), 'base64url')).toString('utf8')).text;

/// What keeps the studio out of the site, or null: scripts/studio makes it, over the core of scripts/wasm.
export function missingOf(folder) {
  const there = ['index.html', 'studio.html'].every(name => existsSync(join(folder, name)));
  return there ? null : `no studio in ${folder} (make wasm, then make studio)`;
}

// A page from a file may neither fetch nor start a worker from a file: there the page with the core in it takes over.
const onDisk = `'use strict';
if (location.protocol === 'file:') location.replace('studio.html' + location.hash);
`;

export function copyStudio(from, to) {
  cpSync(from, to, {recursive: true});
  const html = readFileSync(join(from, 'index.html'), 'utf8'),
    begin = html.indexOf('<script');
  if (begin < 0) throw new Error(`${from}/index.html has no script`);
  writeFileSync(
    join(to, 'index.html'),
    `${html.slice(0, begin)}<script src="on_disk.js"></script>\n${html.slice(begin)}`,
  );
  writeFileSync(join(to, 'on_disk.js'), onDisk);
}
