import {h} from '../dom';

/** Buttons for signs that a keyboard of glass hides; it stays open, as the field keeps the focus. */
export function signButtons(signs: Iterable<string>, type: (sign: string) => void): HTMLElement {
  return h(
    'div',
    {
      class: 'signs',
      role: 'group',
      'aria-label': 'Signs to type',
      onpointerdown: (event: Event) => event.preventDefault(),
    },
    ...[...signs].map(sign => h('button', {type: 'button', onclick: () => type(sign)}, sign)),
  );
}

/** Greek letters of a text, each once, and what formulas are written with. */
export const signsOf = (text: string): Set<string> =>
  new Set([...(text.match(/\p{Script=Greek}/gu) ?? []), ..."'^=()/"]);
