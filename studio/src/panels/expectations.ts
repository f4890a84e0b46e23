import type {ExpectationResult, Trouble} from '../contract';
import {byId, h, prose} from '../dom';
import type {State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {troubleElement} from './equations';

/** The `expect` and `claim` lines of the model, carried out when this is opened. */
export function expectationsPanel(store: Store<State>, study: Study): void {
  const part = byId<HTMLDetailsElement>('expectations'),
    body = byId('expectations-body');
  let of = '';
  const show = async (): Promise<void> => {
    const {openedText, readable, answered} = store.state;
    if (!part.open || !readable || !answered || of === openedText) return;
    of = openedText;
    body.replaceChildren(h('p', {class: 'muted'}, 'They are carried out …'));
    const answer = await study.asker.ask<{results: ExpectationResult[]}>({do: 'expectations', budget: 60});
    if (of !== openedText) return;
    if (!answer.ok && answer.kind === 'cancelled') {
      of = ''; // the text or a value changed: they are carried out again when everything rests
      return body.replaceChildren();
    }
    body.replaceChildren(
      ...(answer.ok ? resultsElements(answer.results) : [troubleElement(answer.trouble as Trouble)]),
    );
  };
  part.addEventListener('toggle', () => void show());
  store.watch(['openedText', 'readable', 'answered'], ({openedText, readable}) => {
    if (readable && of !== '' && of !== openedText) {
      of = '';
      body.replaceChildren();
    }
    void show();
  });
}

function resultsElements(results: ExpectationResult[]): Node[] {
  if (results.length === 0)
    return [h('p', {class: 'muted'}, 'The model has none: an `expect` line says what must hold.')];
  return [
    h(
      'ul',
      {class: 'checks'},
      ...results.map(r =>
        h(
          'li',
          {},
          h(
            'span',
            {class: r.passed ? 'good' : 'bad', role: 'img', 'aria-label': r.passed ? 'holds' : 'fails'},
            r.passed ? '✓' : '✗',
          ),
          h(
            'span',
            {},
            h('code', {}, r.text),
            r.passed
              ? r.where
                ? h('p', {}, ...prose(`It holds where ${r.where}.`))
                : ''
              : h('p', {}, ...prose([r.message, r.pitfall].filter(Boolean).join(' '))),
          ),
          h('span', {class: 'muted'}, r.actual),
        ),
      ),
    ),
  ];
}
