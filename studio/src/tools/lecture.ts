import type {Clock} from '../clock';
import type {Line} from '../contract';
import {h, prose} from '../dom';
import {Stage} from '../drawing/stage';
import {excess, fit, lineElement} from '../panels/formulas';
import {pretty} from '../panels/words';
import type {State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';

interface Step {
  title: string;
  line: Line;
  notes: string[];
}

/**
 * The lines of the derivation one after the other; notes of the model stand at the first step of their part, before
 * all, and after all.
 */
function stepsOf(state: State): Step[] {
  const equations = state.equations!,
    sections = [...(equations.derivation ?? [])];
  const steps = sections.flatMap(section =>
    section.lines.map((line, i): Step => ({title: section.title, line, notes: i === 0 ? (section.notes ?? []) : []})),
  );
  const holds = equations.holds ? [equations.holds] : [];
  steps.push(...equations.equations.map((line): Step => ({title: 'Equations of motion', line, notes: holds})));
  const rates = equations.in_rates;
  if (rates)
    for (const line of [...rates.definitions, ...rates.equations])
      steps.push({title: 'Equations of motion in rates', line, notes: holds});
  steps[0]?.notes.unshift(...(equations.first_notes ?? []));
  if (equations.last_notes?.length) steps.at(-1)!.notes = [...steps.at(-1)!.notes, ...equations.last_notes];
  return steps;
}

/** A formula that is wider than the board takes the place of its rule too, and is set smaller if that is not enough. */
function whole(line: HTMLElement): void {
  if (excess(line) <= 1.001) return;
  line.classList.add('wide');
  const mathematics = line.querySelector<HTMLElement>('.mathematics');
  if (mathematics) fit(mathematics, 0.45);
}

/** Full screen, large type: the derivation line by line, the drawing beside it. */
export async function lecture(store: Store<State>, study: Study, clock: Clock, stages: Set<Stage>): Promise<void> {
  await study.wantSteps();
  if (!store.state.equations?.derivation) return study.say('There are no equations to go through yet.', true);
  const steps = stepsOf(store.state);
  const {run, opened} = store.state,
    drawn = run ? run.drawing !== null : !opened?.fields;
  let at = 0;
  const lines = h('div', {class: 'lines', 'aria-live': 'polite'}),
    title = h('h2', {}),
    note = h('div', {class: 'note', 'aria-live': 'polite'}),
    count = h('output', {}),
    canvas = h('canvas', {role: 'img', 'aria-label': 'Drawing of the system in motion'});
  const go = (to: number): void => {
    at = Math.min(steps.length - 1, Math.max(0, to));
    show();
  };
  const button = (text: string, label: string, act: () => void): HTMLElement =>
    h('button', {type: 'button', 'aria-label': label, title: label, onclick: act}, text);
  const box = h(
    'dialog',
    {id: 'lecture', class: drawn ? '' : 'undrawn', 'aria-label': 'Lecture'},
    h('section', {class: 'board'}, title, lines),
    h('section', {class: 'scene'}, h('h3', {}, store.state.equations.title), drawn ? canvas : '', note),
    h(
      'footer',
      {},
      button('←', 'The line before', () => go(at - 1)),
      count,
      button('→', 'The next line', () => go(at + 1)),
      drawn ? button('▶', 'Play and pause', () => clock.play(!clock.playing)) : '',
      button('×', 'End the lecture', () => box.close()),
    ),
  );

  function show(): void {
    const step = steps[at],
      first = steps.findIndex(one => one.title === step.title);
    title.replaceChildren(...prose(pretty(step.title)));
    const shown = steps.slice(first, at + 1).map(one => lineElement(one.line));
    shown.at(-1)!.classList.add('now');
    lines.replaceChildren(...shown);
    shown.forEach(whole);
    shown.at(-1)!.scrollIntoView({block: 'nearest'});
    const said =
      steps
        .slice(0, at + 1)
        .reverse()
        .find(one => one.notes.length > 0)?.notes ?? [];
    note.replaceChildren(...said.map(text => h('p', {}, ...prose(text))));
    count.textContent = `${at + 1} / ${steps.length}`;
  }

  box.addEventListener('keydown', event => {
    const act: Record<string, () => void> = {
      ArrowRight: () => go(at + 1),
      PageDown: () => go(at + 1),
      ArrowLeft: () => go(at - 1),
      PageUp: () => go(at - 1),
      Home: () => go(0),
      End: () => go(steps.length - 1),
      ' ': () => clock.play(!clock.playing),
    };
    if (
      !act[event.key] ||
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      (event.key === ' ' && (event.target as HTMLElement).closest('button'))
    )
      return;
    event.preventDefault();
    event.stopPropagation();
    act[event.key]();
  });
  document.body.append(box);
  const stage = drawn ? new Stage(canvas, store, clock, study) : null;
  if (stage) stages.add(stage);
  box.addEventListener('close', () => {
    if (stage) stages.delete(stage);
    stage?.end();
    box.remove();
    if (document.fullscreenElement) void document.exitFullscreen();
  });
  // a browser may refuse; the dialog fills the window all the same
  await document.documentElement.requestFullscreen?.().catch(() => {});
  box.showModal();
  box.focus();
  show();
}
