import {h} from '../dom';

/** A dialog that stays in the page: `content` in it, closed by Escape, by its button, or by a click beside it. */
export function dialog(
  title: string,
  content: (Node | string)[],
  buttons: HTMLElement[] = [],
  classes = '',
): HTMLDialogElement {
  const id = `dialog-${Math.random().toString(36).slice(2)}`;
  const close = h('button', {type: 'button', class: 'icon', 'aria-label': 'Close', onclick: () => box.close()}, '×');
  const box = h(
    'dialog',
    {'aria-labelledby': id, class: classes},
    h('header', {}, h('h2', {id}, title), close),
    h('div', {class: 'content', tabindex: 0}, ...content),
    buttons.length > 0 && h('footer', {}, ...buttons),
  );
  box.addEventListener('close', () => box.remove());
  box.addEventListener('click', event => {
    if (event.target === box) box.close();
  });
  document.body.append(box);
  box.showModal();
  return box;
}

/** A line of text from the user; null where there was none. */
export function ask(title: string, label: string, value: string, action: string): Promise<string | null> {
  return new Promise(resolve => {
    const field = h('input', {type: 'text', value, 'aria-label': label, autocomplete: 'off'});
    let answer: string | null = null;
    const form = h(
      'form',
      {
        method: 'dialog',
        onsubmit: () => {
          answer = field.value.trim();
        },
      },
      h('label', {}, label, field),
      h('p', {class: 'actions'}, h('button', {type: 'submit', class: 'primary'}, action)),
    );
    const box = dialog(title, [form]);
    box.addEventListener('close', () => resolve(answer));
    field.select();
  });
}

/** One of several ways; null: none was taken. */
export function choose<T>(title: string, content: (Node | string)[], ways: [string, T][]): Promise<T | null> {
  return new Promise(resolve => {
    let answer: T | null = null;
    const buttons = ways.map(([name, way], i) =>
      h(
        'button',
        {
          type: 'button',
          class: i === 0 ? 'primary' : '',
          onclick: () => {
            answer = way;
            box.close();
          },
        },
        name,
      ),
    );
    const box = dialog(title, content, buttons);
    box.addEventListener('close', () => resolve(answer));
  });
}
