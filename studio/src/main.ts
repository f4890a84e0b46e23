import {Asker} from './asker';
import type {Carrier} from './carriers/carrier';
import {HttpCarrier} from './carriers/http';
import {embeddedCore, WorkerCarrier} from './carriers/worker';
import {Clock} from './clock';
import {byId, copyText, h} from './dom';
import {Stage} from './drawing/stage';
import {Editor} from './editor/editor';
import {EquationsPanel} from './panels/equations';
import {expectationsPanel} from './panels/expectations';
import {showMessages} from './panels/messages';
import {MotionPanel} from './panels/motion';
import {ValuesPanel} from './panels/values';
import {PlotsPanel} from './plots/panel';
import {paintMaps} from './plots/maps';
import {initialState, type Pane, type State} from './state';
import {Store} from './store';
import {Study} from './study';
import {applied} from './tools/apply';
import {Exercises} from './tools/exercises';
import {exportDialog} from './tools/exports';
import {example, FileTools} from './tools/files';
import {helpDialog, pageKeys} from './tools/keys';
import {lecture} from './tools/lecture';
import {decodeShared, encodeShared} from './tools/share';
import {Storage_} from './tools/storage';
import {themes} from './tools/theme';

/**
 * A static page names the script of the worker that holds the core, or holds the core itself; without either there is
 * a server.
 */
function carrierOf(): Carrier {
  const core = document.documentElement.dataset.core;
  if (!core) return new HttpCarrier();
  return new WorkerCarrier(core === 'embedded' ? embeddedCore() : Promise.resolve({script: core}));
}

const storage = new Storage_(),
  store = new Store<State>({...initialState, storage: storage.works}),
  clock = new Clock();
const carrier = carrierOf(),
  asker = new Asker(carrier),
  study = new Study(store, asker, clock);
const stage = new Stage(byId<HTMLCanvasElement>('drawing'), store, clock, study),
  stages = new Set([stage]);
const editor: Editor = new Editor(store, study, (messages, fixes) =>
  showMessages(messages, fixes, () => editor, asker),
);
const plots = new PlotsPanel(store, clock);
new ValuesPanel(store, study);
new EquationsPanel(store, study);
new MotionPanel(store, study, clock, stage);
expectationsPanel(store, study);
const files = new FileTools(store, study, carrier);
new Exercises(store, study, storage);
themes(storage, () => {
  for (const one of stages) one.recolour();
  plots.recolour();
});
  paintMaps(document);

// ----------------------------------------------------------------------------------------------------------- the bar

function panes(): void {
  const small = matchMedia('(max-width: 759px)'),
    tabs = [...document.querySelectorAll<HTMLElement>('#tabs button')];
  for (const tab of tabs) tab.addEventListener('click', () => store.update({pane: tab.dataset.pane as Pane}));
  store.watch(['pane'], ({pane}) => {
    document.body.dataset.pane = pane;
    for (const tab of tabs) tab.setAttribute('aria-current', String(tab.dataset.pane === pane));
    if (small.matches) scrollTo(0, 0);
  });
}

/**
 * What the address says that the page holds: an address that is not true any more is taken back, so that a reload
 * keeps the text.
 */
let linked: string | null = null;
const asLinked = (): string => JSON.stringify([store.state.text, store.state.set, store.state.start]);
store.watch(['text', 'set', 'start'], () => {
  if (linked === null || linked === asLinked()) return;
  linked = null;
  history.replaceState(null, '', location.href.split('#')[0]);
});

async function share(): Promise<void> {
  const {text, set, start, name} = store.state,
    link = `${location.href.split('#')[0]}#m=${await encodeShared({text, set, start, name})}`;
  history.replaceState(null, '', link);
  linked = asLinked();
  const copied = await copyText(link);
  study.say(
    copied
      ? 'The link is copied. It holds the whole model; no server sees it.'
      : 'The address of this page is the link now: it holds the whole model.',
  );
}

function applyValues(): void {
  const {text, set, start} = store.state,
    {edits, missing} = applied(text, set, start);
  if (missing.length > 0) return study.say(`The text has no \`param\` for ${missing.join(', ')}.`, true);
  store.update({set: {}, start: {}});
  editor.apply(edits, false);
  study.say('The values stand in the text now; undo takes them back.');
}

function bar(): void {
  byId('share-button').addEventListener('click', () => void share());
  byId('export-button').addEventListener('click', () => exportDialog(store, study));
  byId('help-button').addEventListener('click', () => helpDialog(store.state.version));
  byId('lecture-button').addEventListener('click', () => void lecture(store, study, clock, stages));
  byId('format-button').addEventListener('click', () => void editor.format());
  byId('rename-button').addEventListener('click', () => void editor.rename());
  byId('search-button').addEventListener('click', () => editor.find());
  byId('reset-values').addEventListener('click', () => study.resetValues());
  byId('apply-values').addEventListener('click', applyValues);
  byId('duration').addEventListener('change', event =>
    study.setDuration((event.target as HTMLInputElement).value.trim()),
  );
  byId('mode').addEventListener('change', event => study.setMode((event.target as HTMLSelectElement).value));
  store.watch(['duration'], ({duration}) => {
    byId<HTMLInputElement>('duration').value = duration;
  });
  store.watch(['equations', 'mode'], ({equations, mode}) => {
    const modes = equations?.modes ?? [];
    byId('mode-row').hidden = modes.length === 0 && !mode;
    byId('mode').replaceChildren(
      h('option', {value: ''}, 'as the motion is'),
      ...modes.map(one => h('option', {value: one, selected: one === mode}, one)),
    );
  });
  store.watch(['busy', 'progress'], ({busy, progress}) => {
    const sign = byId('busy');
    sign.className = busy ? 'busy' : '';
    sign.textContent = busy === 'run' && progress !== null && progress > 0.02 ? `${Math.round(100 * progress)} %` : '';
  });
  pageKeys({
    play: () => clock.play(!clock.playing),
    seek: part => {
      clock.play(false);
      clock.seek(clock.s + part * clock.duration);
    },
    start: () => clock.seek(0),
    pin: () => study.pin(),
    save: () => void files.save(),
    open: () => void files.open(),
    lecture: () => void lecture(store, study, clock, stages),
    help: () => helpDialog(store.state.version),
  });
}

/** What the page says, for the eye a while, and for a screen reader. */
function words(): void {
  let timer = 0;
  store.watch(['word'], ({word}) => {
    const place = byId('word');
    window.clearTimeout(timer);
    place.className = word ? (word.trouble ? 'shown trouble' : 'shown') : '';
    place.textContent = word?.text ?? '';
    if (word)
      timer = window.setTimeout(
        () => store.update({word: null}),
        Math.max(4000, 70 * word.text.length) * (word.trouble ? 2 : 1),
      );
  });
}

// ----------------------------------------------------------------------------------------------------- kept and found

function keep(): void {
  let timer = 0;
  const write = (): void => {
    const {text, name, set, start, origin} = store.state;
    if (!text) return;
    const kept = storage.write({
      text,
      name,
      set,
      start,
      path: origin?.path ?? null,
      version: origin?.version ?? '',
      saved: origin?.saved ?? '',
      at: Date.now(),
    });
    if (kept !== store.state.storage) store.update({storage: kept});
  };
  store.watch(['text', 'set', 'start', 'origin', 'name'], () => {
    window.clearTimeout(timer);
    timer = window.setTimeout(write, 400);
  });
  addEventListener('pagehide', write);
}

/** Another program may write the file while this page is away. */
async function lookAgain(): Promise<void> {
  const {origin, text} = store.state;
  if (!origin || !carrier.files) return;
  const file = await carrier.files.read(origin.path);
  if ('message' in file || file.version === origin.version || store.state.origin !== origin) return;
  if (text !== origin.saved)
    return study.say(`${origin.path} was changed elsewhere. When you save, both texts are shown.`, true);
  study.edit(file.text);
  store.update({origin: {...origin, version: file.version, saved: file.text}});
  study.say(`${origin.path} was changed elsewhere; this is the new text.`);
}

async function fromLink(): Promise<boolean> {
  const code = /^#m=(.+)$/.exec(location.hash)?.[1],
    name = /^#example=([\w-]+)$/.exec(location.hash)?.[1];
  if (name) {
    const text = example(name);
    if (text === null) study.say(`There is no example ${name}.`, true);
    else study.load({text, name});
    linked = asLinked();
    return text !== null;
  }
  if (!code) return false;
  const shared = await decodeShared(code);
  if (shared) study.load({text: shared.text, name: shared.name ?? 'shared', set: shared.set, start: shared.start});
  linked = asLinked();
  if (!shared) study.say('The link is broken: a part of it is missing or was changed. Ask for it again, whole.', true);
  return shared !== null;
}

async function begin(): Promise<void> {
  const [linked, listing] = await Promise.all([fromLink(), carrier.files?.list()]);
  if (linked) return;
  const draft = storage.read(),
    wanted = listing?.open;
  if (wanted && draft?.path !== wanted && (await files.read(wanted))) return;
  if (draft) {
    study.load({
      text: draft.text,
      name: draft.name,
      set: draft.set,
      start: draft.start,
      origin: draft.path && carrier.files ? {path: draft.path, version: draft.version, saved: draft.saved} : null,
    });
    return void lookAgain();
  }
  if (wanted && (await files.read(wanted))) return;
  study.load({text: example('double_pendulum') ?? '', name: 'double_pendulum'});
}

panes();
bar();
words();
keep();
addEventListener('hashchange', () => void fromLink());
addEventListener('focus', () => void lookAgain());
void begin().then(async () => {
  const hello = await asker.ask<{version: string}>({do: 'hello'});
  if (hello.ok) store.update({version: hello.version});
  else if (hello.kind === 'connection') store.update({equationsTrouble: hello.trouble});
});
