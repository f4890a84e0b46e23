import {byId, h, prose} from '../dom';
import type {State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {dialog} from './dialog';
import {exercises, type FileTools} from './files';
import {signButtons, signsOf} from './signs';
import type {Storage_} from './storage';

/** Notes before the model ask; those behind it comment on the answer, and are not in the text that the student sees. */
function partsOf(text: string): {question: string[]; comments: string[]; asking: string} {
  const begin = text.search(/^(param|coord|let)\b/m),
    notes = [...text.matchAll(/^note\s+"([^"]*)"[^\n]*\n?/gm)];
  const of = (before: boolean): string[] => notes.filter(note => note.index < begin === before).map(note => note[1]);
  const asking = notes.reduceRight(
    (left, note) => (note.index < begin ? left : left.slice(0, note.index) + left.slice(note.index + note[0].length)),
    text,
  );
  return {question: of(true), comments: of(false), asking};
}

/** With a capital and a full stop; a formula that it begins with keeps its letters. */
export function asSentence(text: string): string {
  const begins = /^(the|an?|one|numbers|it|its|this|both|there|without|with|only|in|of|terms?|signs?|units?|on)\s+/;
  const words = new RegExp(begins.source + /(?!(sin|cos|tan|exp|log|sqrt)\b)[a-z]{3,}/.source);
  return (words.test(text) ? text[0].toUpperCase() + text.slice(1) : text) + (/[.!?]$/.test(text) ? '' : '.');
}

/** Models that ask: the student types an equation of motion and hears whether it is right, and which pitfall if not. */
export class Exercises {
  private solved: Set<string>;
  private current: string | null = null;

  constructor(
    private readonly store: Store<State>,
    private readonly study: Study,
    private readonly storage: Storage_,
    private readonly files: FileTools,
  ) {
    this.solved = new Set((storage.setting('solved') ?? '').split(' ').filter(Boolean));
    byId('exercises-button').addEventListener('click', () => this.list());
    byId('exercises-button').hidden = exercises().length === 0;
    store.watch(['name', 'origin'], () => {
      if (store.state.name !== this.current) this.end();
    });
  }

  private list(): void {
    const box = dialog(
      'Exercises',
      [
        h(
          'p',
          {},
          'Read the model, write its equation of motion, and hear whether it is right. The answer is not given away.',
        ),
        h(
          'section',
          {class: 'models'},
          h(
            'ol',
            {},
            ...exercises().map(one =>
              h(
                'li',
                {},
                h(
                  'button',
                  {
                    type: 'button',
                    onclick: () => {
                      box.close();
                      void this.begin(one.name, one.title, one.text);
                    },
                  },
                  one.title,
                  h('small', {}, this.solved.has(one.name) ? '✓ solved' : ''),
                ),
              ),
            ),
          ),
        ),
      ],
      [],
      'wide',
    );
  }

  private async begin(name: string, title: string, text: string): Promise<void> {
    if (!(await this.files.mayLeave())) return;
    this.current = name;
    const {question, comments: said, asking} = partsOf(text),
      asked = / motion of ([^.,;]* )?(\S+?)[.,;]/.exec(question.join(' '))?.[2] ?? '',
      coordinate = asked || 'q';
    this.study.load({text: asking, name});
    const field = h('input', {
      type: 'text',
      id: 'claim',
      autocomplete: 'off',
      spellcheck: 'false',
      placeholder: `${coordinate}'' = …`,
      'aria-describedby': 'claim-verdict',
    });
    const verdict = h('div', {id: 'claim-verdict', role: 'status', 'aria-live': 'polite'});
    const comments = h('div', {});
    const form = h(
      'form',
      {
        onsubmit: (event: Event) => {
          event.preventDefault();
          void this.judge(name, field.value, asked, verdict, () =>
            comments.replaceChildren(...said.map(hint => h('p', {class: 'note'}, ...prose(hint))), this.next(name)),
          );
        },
      },
      h('label', {for: 'claim'}, 'Your equation of motion'),
      h('p', {class: 'row'}, field, h('button', {type: 'submit', class: 'primary'}, 'Check')),
      signButtons(signsOf(text), sign =>
        field.setRangeText(sign, field.selectionStart ?? 0, field.selectionEnd ?? 0, 'end'),
      ),
    );
    const leave = h('button', {type: 'button', class: 'quiet', onclick: () => this.end()}, 'Show the equations');
    const panel = h(
      'section',
      {id: 'exercise', 'aria-label': 'Exercise'},
      h('h2', {}, title),
      ...question.map(one => h('p', {}, ...prose(one))),
      form,
      verdict,
      comments,
      h('p', {class: 'muted'}, `Derivatives are ${coordinate}' and ${coordinate}''; products need a blank. `, leave),
    );
    byId('exercise')?.remove();
    byId('equations').prepend(panel);
    document.body.classList.add('exercising');
    this.store.update({pane: 'equations'});
    field.focus();
  }

  private next(name: string): HTMLElement {
    const all = exercises(),
      next = all[all.findIndex(one => one.name === name) + 1];
    if (!next) return h('p', {}, 'That was the last one.');
    const go = (): void => void this.begin(next.name, next.title, next.text);
    return h('p', {}, h('button', {type: 'button', onclick: go}, `Next: ${next.title}`));
  }

  private end(): void {
    this.current = null;
    document.body.classList.remove('exercising');
    byId('exercise')?.remove();
  }

  private async judge(
    name: string,
    text: string,
    asked: string,
    verdict: HTMLElement,
    right: () => void,
  ): Promise<void> {
    verdict.replaceChildren(h('p', {class: 'muted'}, 'It is checked …'));
    const answer = await this.study.claim(text, asked);
    if (!answer.ok) {
      const inside = (
          answer.diagnostics as
            {from: number | null; to: number | null; message: string; reason: string; help: string}[] | undefined
        )?.[0],
        t = inside ?? answer.trouble;
      const place =
        inside && inside.from !== null && inside.to !== null && inside.to > inside.from
          ? h(
              'p',
              {},
              h(
                'code',
                {},
                text.slice(0, inside.from),
                h('mark', {}, text.slice(inside.from, inside.to)),
                text.slice(inside.to),
              ),
            )
          : '';
      return verdict.replaceChildren(
        h(
          'div',
          {class: 'message warning'},
          place,
          h('p', {class: 'what'}, ...prose(t.message)),
          t.reason ? h('p', {}, ...prose(t.reason)) : '',
          t.help ? h('p', {}, ...prose(t.help)) : '',
        ),
      );
    }
    if (!answer.passed)
      return verdict.replaceChildren(
        h(
          'div',
          {class: 'message error'},
          h('p', {class: 'what'}, 'Not yet.'),
          answer.pitfall
            ? h('p', {}, ...prose(asSentence(answer.pitfall)))
            : h(
                'p',
                {},
                'It is none of the usual pitfalls. Check units, signs and which coordinates the velocities depend on.',
              ),
        ),
      );
    const said = answer.where ? `✓ Right where ${answer.where}.` : '✓ Right.';
    verdict.replaceChildren(h('div', {class: 'message right'}, h('p', {class: 'what'}, ...prose(said))));
    this.solved.add(name);
    this.storage.setSetting('solved', [...this.solved].join(' '));
    right();
  }
}
