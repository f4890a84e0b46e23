import models from 'virtual:models';
import type {Carrier, Files, StoredFile} from '../carriers/carrier';
import {byId, download, h} from '../dom';
import {endsAlike, fileOf, linesOf, type Lines} from '../lines';
import type {State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {ask, choose, dialog} from './dialog';
import type {Storage_} from './storage';

const titleOf = (text: string, name: string): string =>
  /^system\s+\S+\s+"([^"]+)"/m.exec(text)?.[1] ?? name.replaceAll('_', ' ');
const folders: [string, string][] = [
  ['examples', 'Mechanics'],
  ['degenerate', 'Degenerate Lagrangians'],
  ['fields', 'Fields'],
];
export const exercises = (): {name: string; title: string; text: string}[] =>
  models
    .filter(([folder]) => folder === 'exercises')
    .map(([, name, text]) => ({name, title: titleOf(text, name), text}));
export const example = (name: string): string | null =>
  models.find(([folder, one]) => folder !== 'exercises' && one === name)?.[2] ?? null;

/** Models from the opened folder, from the disk, or from the examples; and back there. */
export class FileTools {
  private readonly files: Files | undefined;

  constructor(
    private readonly store: Store<State>,
    private readonly study: Study,
    carrier: Carrier,
    private readonly storage: Storage_,
  ) {
    this.files = carrier.files;
    byId('open-button').addEventListener('click', () => void this.open());
    byId('save-button').addEventListener('click', () => void this.save());
    store.watch(['name', 'origin', 'text', 'saved', 'storage'], () => this.title());
    document.addEventListener('dragover', event => {
      if (event.dataTransfer?.types.includes('Files')) event.preventDefault();
    });
    document.addEventListener('drop', event => {
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      void this.take(file);
    });
  }

  private title(): void {
    const {origin, name, text, saved, storage} = this.store.state;
    byId('document-name').textContent = origin?.path ?? name;
    const lost = this.storage.works ? 'it is too long for the storage of this browser' : 'this browser has no storage';
    byId('document-state').textContent =
      origin || storage ? (text === saved ? '' : ' – changed') : ` – not kept: ${lost}`;
  }

  /** Whether what is changed may be left: another model takes the place of the text, and no undo brings it back. */
  async mayLeave(): Promise<boolean> {
    const {origin, name, text, saved} = this.store.state;
    if (saved === text) return true;
    const way = await choose(
      `${origin?.path ?? name} has changes`,
      ['They are in this page only.'],
      [
        ['Save them', 'save'],
        ['Leave them', 'leave'],
      ],
    );
    return way === 'save' ? this.save() : way === 'leave';
  }

  async open(): Promise<void> {
    const listing = await this.files?.list(),
      field = h('input', {type: 'search', placeholder: 'Search', 'aria-label': 'Search models'});
    const pick = h('input', {
      type: 'file',
      accept: '.lag,text/plain',
      class: 'away',
      tabindex: -1,
      'aria-label': 'A file of this computer',
      onchange: () => {
        const file = pick.files?.[0];
        if (file) {
          box.close();
          void this.take(file);
        }
      },
    });
    const entry = (title: string, name: string, take: () => void): HTMLElement =>
      h(
        'li',
        {'data-words': `${title} ${name}`.toLowerCase()},
        h(
          'button',
          {
            type: 'button',
            onclick: () => {
              box.close();
              take();
            },
          },
          title,
          title === name ? '' : h('small', {}, name),
        ),
      );
    const groups: HTMLElement[] = [];
    if (listing && listing.files.length > 0)
      groups.push(
        group(
          `In ${listing.folder || 'the folder'}`,
          listing.files.map(path => entry(path.split('/').pop()!, path, () => void this.read(path))),
        ),
      );
    for (const [folder, title] of folders)
      groups.push(
        group(
          title,
          models
            .filter(([one]) => one === folder)
            .map(([, name, text]) => entry(titleOf(text, name), name, () => void this.take_example(name, text))),
        ),
      );
    field.addEventListener('input', () => {
      for (const li of box.querySelectorAll<HTMLElement>('li'))
        li.hidden = !li.dataset.words!.includes(field.value.toLowerCase());
      for (const one of groups) one.hidden = ![...one.querySelectorAll('li')].some(li => !li.hidden);
    });
    const box = dialog(
      'Open a model',
      [
        h(
          'p',
          {class: 'row'},
          field,
          h('button', {type: 'button', onclick: () => pick.click()}, 'A file of this computer'),
          pick,
          h(
            'button',
            {
              type: 'button',
              onclick: () => {
                box.close();
                void this.fresh();
              },
            },
            'New',
          ),
        ),
        ...groups,
      ],
      [],
      'wide',
    );
    field.focus();
  }

  private async take_example(name: string, text: string): Promise<void> {
    if (await this.mayLeave()) this.study.load({text, name});
  }

  private async fresh(): Promise<void> {
    if (await this.mayLeave()) this.study.load({text: newModel, name: 'model'});
  }

  private async take(file: File): Promise<void> {
    if (!(await this.mayLeave())) return;
    const text = await file.text();
    if (text.includes('\0')) return this.study.say(`${file.name} is no text.`, true);
    this.study.load({...linesOf(text), name: file.name.replace(/\.lag$/, '')});
    if (!endsAlike(text)) this.tellEnds(file.name);
  }

  private tellEnds(name: string): void {
    this.study.say(`The lines of ${name} end in several ways. Saved, they all end as most of them do.`);
  }

  async read(path: string): Promise<boolean> {
    if (!this.files || !(await this.mayLeave())) return false;
    const file = await this.files.read(path);
    if ('message' in file) {
      this.study.say(`${file.message} ${file.help}`, true);
      return false;
    }
    this.study.load({
      text: file.text,
      ends: file.ends,
      name: path
        .split('/')
        .pop()!
        .replace(/\.lag$/, ''),
      origin: {path, version: file.version},
    });
    if (!file.alike) this.tellEnds(path);
    return true;
  }

  /** Into its file where there is a server, else as a download. */
  async save(): Promise<boolean> {
    const {text, ends, name, origin} = this.store.state;
    if (!this.files) {
      download(`${name}.lag`, 'text/plain', fileOf({text, ends}));
      this.store.update({saved: text});
      this.study.say(`Downloaded as ${name}.lag.`);
      return true;
    }
    let path = origin?.path ?? null;
    if (path === null) {
      path = await ask('Save in the folder', 'Name of the file', `${name}.lag`, 'Save');
      if (!path) return false;
      if (!path.endsWith('.lag')) path += '.lag';
    }
    return this.write(path, {text, ends}, origin?.path === path ? origin.version : null);
  }

  private async write(path: string, lines: Lines, version: string | null): Promise<boolean> {
    const saved = await this.files!.write(path, lines, version);
    if (saved.saved === null) {
      this.study.say(`${saved.trouble.message} ${saved.trouble.reason} ${saved.trouble.help}`, true);
      return false;
    }
    if (saved.saved) {
      this.store.update({
        origin: {path, version: saved.version},
        saved: lines.text,
        name: path
          .split('/')
          .pop()!
          .replace(/\.lag$/, ''),
      });
      this.study.say(`Saved as ${path}.`);
      return true;
    }
    return this.conflict(path, lines, saved.theirs);
  }

  /** Somebody else wrote the file meanwhile: both texts are shown, and nothing is lost. */
  private async conflict(path: string, mine: Lines, theirs: StoredFile): Promise<boolean> {
    const both = h(
      'div',
      {class: 'both'},
      h('section', {}, h('h3', {}, 'In this page'), h('pre', {tabindex: 0}, mine.text)),
      h('section', {}, h('h3', {}, 'In the file'), h('pre', {tabindex: 0}, theirs.text)),
    );
    const way = await choose(
      `${path} was changed elsewhere`,
      [h('p', {}, 'Another program or another tab wrote it since this page read it.'), both],
      [
        ["Keep this page's", 'mine'],
        ["Take the file's", 'theirs'],
        ["Save this page's under another name", 'other'],
      ],
    );
    if (way === 'mine') return this.write(path, mine, theirs.version);
    if (way === 'theirs') {
      this.study.edit(theirs.text);
      this.store.update({origin: {path, version: theirs.version}, saved: theirs.text, ends: theirs.ends});
      this.study.say("Undo brings this page's text back.");
      return true;
    }
    if (way !== 'other') return false;
    const name = await ask('Save under another name', 'Name of the file', path.replace(/\.lag$/, '-2.lag'), 'Save');
    return name ? this.write(name, mine, null) : false;
  }
}

function group(title: string, entries: HTMLElement[]): HTMLElement {
  return h('section', {class: 'models'}, h('h3', {}, title), h('ul', {}, ...entries));
}

const newModel = `system pendulum "Simple pendulum"
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord θ : angle

point bob mass m at l (sin θ, -cos θ)
gravity (0, -g)

start θ = 60 deg
run 10 s
draw O - bob
`;
