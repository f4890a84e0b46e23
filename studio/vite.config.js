// The page as a folder (index.html and hashed files, all addresses relative) and as one file, which the program embeds.
import {createHash} from 'node:crypto';
import {cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {basename, join, resolve} from 'node:path';
import {gzipSync} from 'node:zlib';
import {defineConfig} from 'vite';

const here = import.meta.dirname,
  root = resolve(here, '..');
const outDir = process.env.STUDIO_OUT ?? join(root, 'build/studio');

// The scripts of reports are classic scripts, so that a report is one page; here they are modules.
const reportScripts = {
  name: 'report-scripts',
  transform(code, id) {
    const name = {'scene.js': 'maupScene', 'painter.js': 'maupPainter'}[basename(id)];
    return name && id.includes('/report/page/')
      ? {code: `${code.replace(/^if \(typeof module.*$/m, '')}\nexport default ${name};\n`, map: null}
      : null;
  },
};

// `@dark { … }` are the colours of dark paper: where the system has it and the user did not choose, or where the user
// chose it.
const dark = {
  postcssPlugin: 'dark',
  AtRule: {
    dark(rule, {postcss}) {
      const inside = rule.nodes.map(node => `${node};`).join('');
      const both =
        `@media screen and (prefers-color-scheme: dark) {:root:not([data-theme='light']) {${inside}}}` +
        `@media screen {:root[data-theme='dark'] {${inside}}}`;
      rule.replaceWith(postcss.parse(both, {from: rule.source.input.file}));
    },
  },
};

// `virtual:models`: [folder, name, text] of every model that the page offers.
const folders = {
  examples: join(root, 'models'),
  degenerate: join(root, 'models/degenerate'),
  fields: join(root, 'models/fields'),
  exercises: join(here, 'exercises'),
};
const models = {
  name: 'models',
  resolveId: id => (id === 'virtual:models' ? '\0models' : null),
  load(id) {
    if (id !== '\0models') return null;
    const all = [];
    for (const [folder, path] of Object.entries(folders))
      for (const file of (existsSync(path) ? readdirSync(path) : []).filter(name => name.endsWith('.lag')).sort()) {
        this.addWatchFile(join(path, file));
        all.push([folder, file.slice(0, -4), readFileSync(join(path, file), 'utf8')]);
      }
    return `export default ${JSON.stringify(all)};`;
  },
};

// A script without modules runs from file:// too.
const classicScript = {
  name: 'classic-script',
  enforce: 'post',
  transformIndexHtml: html =>
    html
      .replace(/<script type="module" crossorigin (src="[^"]*")><\/script>/, '<script defer $1></script>')
      .replace(/<link rel="stylesheet" crossorigin /, '<link rel="stylesheet" '),
  closeBundle() {
    const html = readFileSync(join(outDir, 'index.html'), 'utf8'),
      kB = bytes => `${Math.round(bytes / 1000)} kB`;
    const {page, policy} = oneFile(html, {connect: "'self'"}),
      packed = gzipSync(page, {level: 9});
    writeFileSync(join(outDir, 'page.html'), page);
    writeFileSync(join(outDir, 'page.policy'), policy + '\n');
    writeFileSync(join(outDir, 'page.html.gz'), packed);
    console.log(`page.html: ${kB(page.length)}, ${kB(packed.length)} gzip`);
    if (process.env.STUDIO_CORE) staticVariants(html, process.env.STUDIO_CORE, kB);
  },
};

// Style and script stand in the page; the policy names the script by its hash, so that nothing else runs.
function oneFile(html, {connect, head = () => '', body = ''}) {
  let script = '';
  html = html.replace(/<script defer src="\.\/([^"]*)"><\/script>\s*/, (_, file) => {
    script = readFileSync(join(outDir, file), 'utf8').replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
    return '';
  });
  html = html.replace(
    /<link rel="stylesheet" href="\.\/([^"]*)">/,
    (_, file) => `<style>${readFileSync(join(outDir, file), 'utf8')}</style>`,
  );
  const hash = createHash('sha256').update(script).digest('base64');
  const policy =
    `default-src 'none'; script-src 'sha256-${hash}' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; ` +
    `img-src data: blob:; font-src data:; worker-src blob:; connect-src ${connect}; ` +
    `base-uri 'none'; form-action 'none'`;
  html = html.replace('<meta name="viewport"', () => `${head(policy)}<meta name="viewport"`);
  return {page: html.replace('</body>', () => `${body}<script>${script}</script>\n</body>`), policy};
}

// The page with the core beside it, for any static host, and with the core in it, in one file that works from a disk.
function staticVariants(html, core, kB) {
  const folder = outDir + '_static',
    marked = value => html.replace('<html lang="en">', `<html lang="en" data-core="${value}">`);
  rmSync(folder, {recursive: true, force: true});
  mkdirSync(folder, {recursive: true});
  for (const [, file] of html.matchAll(/(?:src|href)="\.\/([^"]*)"/g)) cpSync(join(outDir, file), join(folder, file));
  for (const file of ['maup_worker.js', 'maup.wasm']) cpSync(join(core, file), join(folder, file));
  writeFileSync(join(folder, 'index.html'), marked('maup_worker.js'));
  const wasm = gzipSync(readFileSync(join(core, 'maup.wasm')), {level: 9}),
    worker = readFileSync(join(core, 'maup_worker.js'), 'utf8');
  const data = (id, text) => `<script type="text/plain" id="${id}">${text}</script>\n`;
  if (/<\/script|<!--/i.test(worker)) throw new Error('maup_worker.js cannot stand in a page');
  const {page} = oneFile(marked('embedded'), {
    connect: "'none'",
    head: policy => `<meta http-equiv="Content-Security-Policy" content="${policy}">\n`,
    body: data('core-worker', worker) + data('core-wasm', wasm.toString('base64')),
  });
  writeFileSync(join(folder, 'studio.html'), page);
  console.log(`core: ${kB(wasm.length)} gzip; studio.html: ${kB(page.length)}, ${kB(gzipSync(page).length)} gzip`);
}

export default defineConfig({
  root: here,
  base: './',
  plugins: [reportScripts, models, classicScript],
  css: {postcss: {plugins: [dark]}},
  server: {fs: {allow: [root]}},
  build: {
    outDir,
    emptyOutDir: true,
    cssCodeSplit: false,
    assetsInlineLimit: 100_000,
    modulePreload: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: {
      checks: {bundlerTimings: false}, // on a busy machine it would say what took its time
      output: {format: 'iife', entryFileNames: 'studio-[hash].js', assetFileNames: 'studio-[hash][extname]'},
    },
  },
});
