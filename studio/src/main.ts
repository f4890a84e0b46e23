import {Asker} from './asker';
import type {Carrier} from './carriers/carrier';
import {HttpCarrier} from './carriers/http';
import {embeddedCore, WorkerCarrier} from './carriers/worker';
import {Clock} from './clock';
import {byId, copyText, prose} from './dom';
import {linesOf} from './lines';
import {Stage} from './drawing/stage';
import {Editor} from './editor/editor';
import {EquationsPanel} from './panels/equations';
import {expectationsPanel} from './panels/expectations';
import {showMessages} from './panels/messages';
import {modeOptions} from './panels/words';
import {MotionPanel} from './panels/motion';
import {ValuesPanel} from './panels/values';
import {PlotsPanel} from './plots/panel';
import {initialState, type Pane, type State} from './state';
import {Store} from './store';
import {Study, type Model} from './study';
import {applied} from './tools/apply';
import {Exercises} from './tools/exercises';
import {exportDialog} from './tools/exports';
import {example, FileTools} from './tools/files';
import {helpDialog, pageKeys} from './tools/keys';
import {lecture} from './tools/lecture';
import {signButtons} from './tools/signs';
import {decodeShared, encodeShared} from './tools/share';
import {Storage_, type Draft} from './tools/storage';
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
const editor: Editor = new Editor(store, study, (messages, fixes) => {
  showMessages(messages, fixes, () => editor, asker);
  countMistakes(messages.filter(one => one.severity === 'error').length);
});
const plots = new PlotsPanel(store, clock);
new ValuesPanel(store, study);
new EquationsPanel(store, study);
new MotionPanel(store, study, clock, stage);
expectationsPanel(store, study);
const files = new FileTools(store, study, carrier, storage);
new Exercises(store, study, storage, files);
themes(storage, () => {
  for (const one of stages) one.recolour();
  plots.recolour();
});

// ----------------------------------------------------------------------------------------------------------- the bar

/** On the tab of the text, as its messages may not be in sight. */
function countMistakes(count: number): void {
  const sign = byId('mistakes');
  sign.hidden = count === 0;
  sign.textContent = String(count);
  sign.parentElement!.setAttribute('aria-label', count === 0 ? 'Model' : `Model, ${count} to mend`);
}

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

/** What the address says that the page holds. One that is not true any more is taken back: a reload keeps the text. */
let linked: string | null = null;
const asLinked = (): string => JSON.stringify([store.state.text, store.state.set, store.state.start]);
store.watch(['text', 'set', 'start'], () => {
  if (linked === null || linked === asLinked()) return;
  forgetAddress();
});
function forgetAddress(): void {
  linked = null;
  history.replaceState(null, '', location.href.split('#')[0]);
}

async function share(): Promise<void> {
  const {text, set, start, name} = store.state,
    link = `${location.href.split('#')[0]}#m=${await encodeShared({text, set, start, name})}`;
  history.replaceState(null, '', link);
  linked = asLinked();
  const copied = await copyText(link),
    own = location.protocol === 'file:' || /^(localhost|127\.|\[::1\])/.test(location.hostname),
    here = own ? ' It opens on this machine alone: for another one take the file, `Export`, `Model text`.' : '';
  study.say(
    copied
      ? `The link is copied. It holds the whole model; no server sees it.${here}`
      : `The address of this page is the link now: it holds the whole model.${here}`,
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
  byId('export-button').addEventListener('click', () => exportDialog(store, study, clock));
  byId('help-button').addEventListener('click', () => helpDialog(store.state.version));
  byId('lecture-button').addEventListener('click', () => void lecture(store, study, clock, stages));
  byId('format-button').addEventListener('click', () => void editor.format());
  byId('rename-button').addEventListener('click', () => void editor.rename());
  byId('search-button').addEventListener('click', () => editor.find());
  byId('undo-button').addEventListener('click', () => editor.undo());
  byId('redo-button').addEventListener('click', () => editor.redo());
  byId('editor').after(signButtons("θφωψαΩ'^=()[]#", sign => editor.type(sign)));
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
    byId('mode').replaceChildren(...modeOptions(modes, mode));
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
    place.replaceChildren(...prose(word?.text ?? ''));
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
    const {text, ends, saved, name, set, start, origin} = store.state;
    if (!text) return;
    const kept = storage.write({
      text,
      ends,
      saved,
      name,
      set,
      start,
      path: origin?.path ?? null,
      version: origin?.version ?? '',
      at: Date.now(),
    });
    if (kept !== store.state.storage) store.update({storage: kept});
  };
  store.watch(['text', 'saved', 'set', 'start', 'origin', 'name'], () => {
    window.clearTimeout(timer);
    timer = window.setTimeout(write, 400);
  });
  addEventListener('pagehide', write);
}

/** Another program may write the file while this page is away. */
async function lookAgain(): Promise<void> {
  const {origin, text, saved} = store.state;
  if (!origin || !carrier.files) return;
  const file = await carrier.files.read(origin.path);
  if ('message' in file || file.version === origin.version || store.state.origin !== origin) return;
  if (text !== saved)
    return study.say(`${origin.path} was changed elsewhere. When you save, both texts are shown.`, true);
  study.edit(file.text);
  store.update({origin: {...origin, version: file.version}, saved: file.text, ends: file.ends});
  study.say(`${origin.path} was changed elsewhere; this is the new text.`);
}

/** The model that the address holds; null where it holds none, or none that can be read. */
async function inAddress(): Promise<Model | null> {
  const code = /^#m=(.+)$/.exec(location.hash)?.[1],
    name = /^#example=([\w-]+)$/.exec(location.hash)?.[1];
  if (name) {
    const text = example(name);
    if (text === null) study.say(`There is no example ${name}.`, true);
    return text === null ? null : {text, name};
  }
  if (!code) return null;
  const shared = await decodeShared(code);
  if (!shared) study.say('The link is broken: a part of it is missing or was changed. Ask for it again, whole.', true);
  return shared && {...shared, name: shared.name ?? 'shared'};
}

/** False where the address holds no model, or the user stays with what is changed. */
async function fromAddress(): Promise<boolean> {
  const model = await inAddress(),
    taken = model !== null && (await files.mayLeave());
  if (taken) study.load(model);
  else if (model) forgetAddress();
  if (location.hash) linked = asLinked();
  return taken;
}

function fromDraft(draft: Draft): void {
  const {text, ends} = linesOf(draft.text),
    saved = draft.path || draft.saved ? linesOf(draft.saved).text : text;
  study.load({
    text,
    ends: draft.ends ?? ends,
    saved,
    name: draft.name,
    set: draft.set,
    start: draft.start,
    origin: draft.path && carrier.files ? {path: draft.path, version: draft.version} : null,
  });
}

async function begin(): Promise<void> {
  await storage.begin();
  const own = storage.own(),
    changed = own !== null && own.saved !== '' && own.text !== own.saved;
  // A link that is opened in this tab asks before it takes the place of what is changed.
  if (changed && location.hash) fromDraft(own);
  const [taken, listing] = await Promise.all([fromAddress(), carrier.files?.list()]);
  if (taken || store.state.loads > 0) return;
  const draft = storage.read(),
    wanted = listing?.open;
  if (wanted && draft?.path !== wanted && (await files.read(wanted))) return;
  if (draft) {
    fromDraft(draft);
    return void lookAgain();
  }
  if (wanted && (await files.read(wanted))) return;
  study.load({text: example('double_pendulum') ?? '', name: 'double_pendulum'});
}

panes();
bar();
words();
keep();
addEventListener('hashchange', () => void fromAddress());
addEventListener('focus', () => void lookAgain());
void begin().then(async () => {
  const hello = await asker.ask<{version: string}>({do: 'hello'});
  if (hello.ok) store.update({version: hello.version});
  else if (hello.kind === 'connection') store.update({equationsTrouble: hello.trouble});
});
