import {h} from '../dom';
import {dialog} from './dialog';

const mac = /Mac|iP/.test(navigator.platform),
  mod = mac ? '⌘' : 'Ctrl';
const keys: [string, [string, string][]][] = [
  [
    'Motion',
    [
      ['Space', 'play and pause'],
      ['← →', 'a little back or on; with Shift more'],
      ['Home', 'to the start'],
      ['P', 'pin this run'],
    ],
  ],
  [
    'Page',
    [
      [`${mod} S`, 'save'],
      [`${mod} O`, 'open'],
      ['L', 'lecture'],
      ['?', 'this help'],
    ],
  ],
  [
    'Text',
    [
      [`${mod} Space`, 'complete'],
      ['F2', 'rename'],
      ['F12', 'to the declaration'],
      ['Shift F12', 'the next use'],
      ['Shift Alt F', 'format'],
      [`${mod} .`, 'mend what is underlined here'],
      ['F8', 'the next message'],
      [`${mod} F`, 'find'],
      [`${mod} Shift [ ]`, 'fold and unfold'],
      [`${mod} Z`, 'undo'],
      ['Escape, Tab', 'leave the text by keyboard'],
    ],
  ],
  [
    'Drawing',
    [
      ['Drag a body', 'another start; the motion begins anew when you let go'],
      ['Drag beside', 'shift it, in space turn it'],
      ['Wheel, two fingers', 'nearer and farther'],
      ['Double click', 'the whole view'],
    ],
  ],
];

export function helpDialog(version: string): void {
  dialog(
    'Help',
    [
      h(
        'p',
        {},
        'Write a model; its equations and its motion follow while you type. Every value is a slider, every body can ' +
          'be dragged. Nothing leaves your computer.',
      ),
      ...keys.map(([title, list]) =>
        h(
          'section',
          {},
          h('h3', {}, title),
          h(
            'dl',
            {class: 'keys'},
            ...list.flatMap(([key, what]) => [h('dt', {}, h('kbd', {}, key)), h('dd', {}, what)]),
          ),
        ),
      ),
      h('p', {class: 'muted'}, version ? `Maupertuis ${version}` : 'Maupertuis'),
    ],
    [],
    'wide',
  );
}

/** Keys of the page: they leave fields, buttons and the text alone. */
export function pageKeys(actions: {
  play(): void;
  seek(part: number): void;
  start(): void;
  pin(): void;
  save(): void;
  open(): void;
  lecture(): void;
  help(): void;
}): void {
  document.addEventListener('keydown', event => {
    const target = event.target as HTMLElement,
      open = document.querySelector('dialog[open]');
    if ((event.ctrlKey || event.metaKey) && !event.altKey && !open) {
      if (event.key === 's') {
        event.preventDefault();
        actions.save();
      }
      if (event.key === 'o') {
        event.preventDefault();
        actions.open();
      }
      return;
    }
    if (event.altKey || event.ctrlKey || event.metaKey || open || event.defaultPrevented) return;
    if (
      target.closest('.cm-editor, input:not(#scrub), select, textarea') ||
      (event.key === ' ' && target.closest('button, summary, a'))
    )
      return;
    const action: Record<string, () => void> = {
      ' ': actions.play,
      ArrowRight: () => actions.seek(event.shiftKey ? 0.05 : 0.005),
      ArrowLeft: () => actions.seek(event.shiftKey ? -0.05 : -0.005),
      Home: actions.start,
      p: actions.pin,
      l: actions.lecture,
      '?': actions.help,
    };
    const wanted = action[event.key];
    if (!wanted) return;
    event.preventDefault();
    wanted();
  });
}
