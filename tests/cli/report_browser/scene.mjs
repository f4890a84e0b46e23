// The camera of the page against that of the library: `node scene.mjs WRITER SCENE.js`. Both make the same strokes of a
// moment.
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const [writer, script] = process.argv.slice(2), folder = mkdtempSync(join(tmpdir(), 'maup-scene-'));
const maupScene = createRequire(import.meta.url)(script);
let failures = 0, compared = 0;
const check = (what, good, detail) => {
  ++compared;
  if (good || ++failures > 20) return;
  console.error(`FAILED: ${what}`, detail ?? '');
};

for (const name of ['scene-plane', 'scene-space']) {
  const file = join(folder, name);
  if (spawnSync(writer, [name, file], {stdio: 'inherit'}).status !== 0) throw new Error(`${writer} failed`);
  const {scene, width, height, moments} = JSON.parse(readFileSync(file, 'utf8'));
  for (const element of scene.elements) element.positions = element.positions.map(value => value ?? NaN);
  const view = maupScene.makeView(scene, width, height);
  for (const {elapsed, items} of moments) {
    const own = maupScene.frameItems(scene, view, elapsed);
    const at = `${name} at ${elapsed} s`;
    check(`${at}: the same things`, own.length === items.length, [own.length, items.length]);
    check(`${at}: something is there`, items.length > 10, items.length);
    const order = new Map(own.map((item, i) => [item.id, i]));
    let before = -1, swaps = 0;
    for (const item of items) {
      const i = order.get(item.id), other = own[i];
      check(`${at}: item ${item.id} is there`, other !== undefined);
      if (!other) continue;
      if (i < before) ++swaps;
      before = i;
      const sizes = [other.points.length, item.points.length];
      check(`${at}: item ${item.id} has its points`, sizes[0] === sizes[1], sizes);
      const worst = Math.max(...item.points.map((x, k) => Math.abs(x - other.points[k])));
      check(`${at}: item ${item.id} is where it is`, worst < 0.02, worst);
      check(`${at}: item ${item.id} has its width`, Math.abs((other.width ?? 0) - item.width) < 1e-3);
      check(`${at}: item ${item.id} has its radius`, Math.abs((other.radius ?? 0) - item.radius) < 0.02);
      check(`${at}: item ${item.id} is closed alike`, Boolean(other.closed) === item.closed);
      const near = Math.abs((other.fill?.strength ?? 0) - item.fill) < 1e-3;
      check(`${at}: item ${item.id} has its fill`, near, [other.fill, item.fill]);
      const series = (other.fill?.series ?? 0) + (other.stroke?.series ?? 0);
      check(`${at}: item ${item.id} has its colour`, series === item.series, [series, item.series]);
      check(`${at}: item ${item.id} has its stroke`, Math.abs((other.stroke?.strength ?? 0) - item.stroke) < 1e-3);
    }
    check(`${at}: the same order`, swaps === 0, swaps);
  }
}
rmSync(folder, {recursive: true, force: true});
console.log(failures === 0 ? `all ${compared} checks passed` : `${failures} of ${compared} checks failed`);
process.exit(failures === 0 ? 0 : 1);
