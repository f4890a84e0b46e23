// The page as a folder (index.html and hashed files, all addresses relative) and as one file, which the program embeds.
import {createHash} from 'node:crypto';
import {existsSync, readFileSync, readdirSync, writeFileSync} from 'node:fs';
import {basename, join, resolve} from 'node:path';
import {gzipSync} from 'node:zlib';
import {defineConfig} from 'vite';

const here = import.meta.dirname, root = resolve(here, '..');
const outDir = process.env.STUDIO_OUT ?? join(root, 'build/studio');

// The scripts of reports are classic scripts, so that a report is one page; here they are modules.
const reportScripts = {
  name: 'report-scripts',
  transform(code, id) {
    const name = {'scene.js': 'maupScene', 'painter.js': 'maupPainter'}[basename(id)];
    return name && id.includes('/report/page/') ? {code: `${code.replace(/^if \(typeof module.*$/m, '')}\nexport default ${name};\n`, map: null} : null;
  },
};

// `virtual:models`: [folder, name, text] of every model that the page offers.
const folders = {examples: join(root, 'models'), degenerate: join(root, 'models/degenerate'), fields: join(root, 'models/fields'),
                 exercises: join(here, 'exercises')};
const models = {
  name: 'models',
  resolveId: id => id === 'virtual:models' ? '\0models' : null,
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

// A script without modules runs from file:// too. One file: style and script stand in it, named by their hashes in the
// policy, so that nothing else runs.
const oneFile = {
  name: 'one-file',
  enforce: 'post',
  transformIndexHtml: html => html.replace(/<script type="module" crossorigin (src="[^"]*")><\/script>/, '<script defer $1></script>')
                                  .replace(/<link rel="stylesheet" crossorigin /, '<link rel="stylesheet" '),
  closeBundle() {
    let html = readFileSync(join(outDir, 'index.html'), 'utf8'), script = '';
    html = html.replace(/<script defer src="\.\/([^"]*)"><\/script>\s*/, (_, file) => {
      script = readFileSync(join(outDir, file), 'utf8').replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
      return '';
    });
    html = html.replace(/<link rel="stylesheet" href="\.\/([^"]*)">/, (_, file) => `<style>${readFileSync(join(outDir, file), 'utf8')}</style>`);
    const hash = createHash('sha256').update(script).digest('base64');
    const policy = `default-src 'none'; script-src 'sha256-${hash}' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:; ` +
                   `font-src data:; worker-src blob:; connect-src 'self'; base-uri 'none'; form-action 'none'`;
    html = html.replace('</body>', () => `<script>${script}</script>\n</body>`);
    writeFileSync(join(outDir, 'page.html'), html);
    writeFileSync(join(outDir, 'page.policy'), policy + '\n');
    const packed = gzipSync(html, {level: 9});
    writeFileSync(join(outDir, 'page.html.gz'), packed);
    console.log(`one file: ${Math.round(html.length / 1000)} kB, ${Math.round(packed.length / 1000)} kB gzip`);
  },
};

export default defineConfig({
  root: here,
  base: './',
  plugins: [reportScripts, models, oneFile],
  server: {fs: {allow: [root]}},
  build: {
    outDir,
    emptyOutDir: true,
    cssCodeSplit: false,
    assetsInlineLimit: 100_000,
    modulePreload: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: {output: {format: 'iife', entryFileNames: 'studio-[hash].js', assetFileNames: 'studio-[hash][extname]'}},
  },
});
