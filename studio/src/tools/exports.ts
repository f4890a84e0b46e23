import type {ExportAnswer} from '../contract';
import {download, h} from '../dom';
import type {State} from '../state';
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

export function exportDialog(store: Store<State>, study: Study): void {
  const make = async (what: string): Promise<void> => {
    box.close();
    study.say('It is made …');
    const answer = await study.asker.ask<ExportAnswer>({do: 'export', what, budget: 60, ...study.values});
    if (!answer.ok) return study.say(`${answer.trouble.message} ${answer.trouble.help}`, true);
    const content = answer.text ?? Uint8Array.from(atob(answer.base64 ?? ''), c => c.charCodeAt(0));
    download(answer.name, answer.type, content as BlobPart);
    study.say(`${answer.name} is in your downloads.`);
  };
  const entries = kinds.map(([what, title, detail]) => h('li', {}, h('button', {type: 'button', onclick: () => void make(what)}, title, h('small', {}, detail))));
  const own = h('li', {}, h('button', {type: 'button', onclick: () => { box.close(); download(`${store.state.name}.lag`, 'text/plain', store.state.text); }}, 'Model text', h('small', {}, '.lag')));
  const box = dialog('Export', [h('section', {class: 'models'}, h('ul', {}, own, ...entries))]);
}
