// What the site knows of mechanics it asks the program.
import {execFile, execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

export class Program {
  constructor(path) {
    this.path = path;
    this.folder = mkdtempSync(join(tmpdir(), 'maup-site-'));
  }
  close() {
    rmSync(this.folder, {recursive: true, force: true});
  }

  json(...options) {
    return JSON.parse(
      execFileSync(this.path, [...options, '--json'], {
        encoding: 'utf8',
        maxBuffer: 1 << 28,
        stdio: ['ignore', 'pipe', 'ignore'],
        timeout: 120_000,
      }),
    );
  }

  // {code, out, errors}: what a command says, whatever its exit code.
  run(...options) {
    return new Promise(done =>
      execFile(this.path, options, {encoding: 'utf8', maxBuffer: 1 << 28, timeout: 120_000}, (error, out, errors) =>
        done({code: error ? (error.code ?? 1) : 0, out, errors}),
      ),
    );
  }

  // The text of the file that a command writes with -o, or null where it refuses.
  async written(name, ...options) {
    const file = join(this.folder, name);
    const {code} = await this.run(...options, '-o', file);
    if (code !== 0) return null;
    const text = readFileSync(file, 'utf8');
    rmSync(file);
    return text;
  }
}

// f over all items, `width` at a time; results in their order.
export async function together(items, width, f) {
  const results = new Array(items.length);
  let next = 0;
  await Promise.all(
    Array.from({length: width}, async () => {
      while (next < items.length) {
        const i = next++;
        results[i] = await f(items[i], i);
      }
    }),
  );
  return results;
}
