import type {Clock} from '../clock';
import type {Answer, ExportAnswer} from '../contract';
import {download, h} from '../dom';
import {fileOf} from '../lines';
import {betweenEnds, type State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {dialog} from './dialog';

const kinds: [string, string, string][] = [
  ['report', 'Report', 'A page with everything, for any browser'],
  ['animation', 'Animation', 'A page with the drawing in motion'],
  ['latex', 'Equations', 'LaTeX'],
  ['csv', 'Motion', 'CSV, full precision'],
  ['json', 'Motion', 'JSON'],
  ['plot.svg', 'Plot', 'SVG'],
  ['plot.png', 'Plot', 'PNG'],
  ['drawing.svg', 'Drawing', 'SVG'],
  ['drawing.png', 'Drawing', 'PNG'],
];

const ofPaths = ['report', 'latex'],
  ofFields = ['report', 'latex', 'csv', 'json'];

/** A picture at twice its size on the screen; null where the browser cannot read it. */
function pixels(svg: string): Promise<Blob | null> {
  return new Promise(resolve => {
    const image = new Image();
    image.onerror = () => resolve(null);
    image.onload = () => {
      const canvas = h('canvas', {width: 2 * image.naturalWidth, height: 2 * image.naturalHeight}),
        context = canvas.getContext('2d')!;
      context.drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob(resolve, 'image/png');
    };
    image.src = URL.createObjectURL(new Blob([svg], {type: 'image/svg+xml'}));
  });
}

/** Files of what stands in the page: its values, its arrows of forces, and of the drawing the moment that is shown. */
export function exportDialog(store: Store<State>, study: Study, clock: Clock): void {
  const make = async (what: string): Promise<void> => {
    box.close();
    study.say('It is made …');
    const ask = (one: string): Promise<Answer<ExportAnswer>> =>
      study.asker.ask<ExportAnswer>({do: 'export', what: one, t: clock.now, budget: 60, ...study.values});
    let answer = await ask(what);
    if (!answer.ok && answer.kind === 'refused' && what.endsWith('.png')) {
      // a core without pixels, as the one in a browser: the browser has them
      const svg = await ask(what.replace('.png', '.svg'));
      const picture = svg.ok ? await pixels(svg.text ?? '') : null;
      if (picture) {
        download(`${store.state.name}_${what}`, 'image/png', picture);
        return study.say(`${store.state.name}_${what} is in your downloads.`);
      }
      if (!svg.ok) answer = svg;
    }
    if (!answer.ok) return study.say(`${answer.trouble.message} ${answer.trouble.help}`, true);
    const content = answer.text ?? Uint8Array.from(atob(answer.base64 ?? ''), c => c.charCodeAt(0));
    download(answer.name, answer.type, content as BlobPart);
    study.say(`${answer.name} is in your downloads.`);
  };
  const still = betweenEnds(store.state),
    made = store.state.opened?.fields ? ofFields : kinds.map(([what]) => what);
  const entries = kinds.filter(([what]) => (still ? ofPaths : made).includes(what)).map(([what, title, detail]) =>
    h('li', {}, h('button', {type: 'button', onclick: () => void make(what)}, title, h('small', {}, detail))),
  );
  const own = h(
    'li',
    {},
    h(
      'button',
      {
        type: 'button',
        onclick: () => {
          box.close();
          download(`${store.state.name}.lag`, 'text/plain', fileOf(store.state));
        },
      },
      'Model text',
      h('small', {}, '.lag'),
    ),
  );
  const box = dialog('Export', [h('section', {class: 'models'}, h('ul', {}, own, ...entries))]);
}
