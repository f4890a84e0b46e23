import type {Asker} from '../asker';
import type {Diagnostic, Fix} from '../contract';
import {byId, h, prose} from '../dom';
import type {Editor} from '../editor/editor';
import {dialog} from '../tools/dialog';

/** The list of what is wrong with the text, beside the lines themselves. */
export function showMessages(list: Diagnostic[], fixes: Fix[], editor: () => Editor, asker: Asker): void {
  const order = {error: 0, warning: 1, note: 2},
    sorted = [...list].sort((a, b) => order[a.severity] - order[b.severity] || (a.from ?? 1e9) - (b.from ?? 1e9));
  const most = 50;
  byId('messages').replaceChildren(
    ...sorted.slice(0, most).map(m => {
      const place =
        m.from === null
          ? h('span', {class: 'muted'}, m.text ? `in ${m.text}` : '')
          : h(
              'button',
              {type: 'button', class: 'link', onclick: () => editor().goTo(m.from!, m.to ?? m.from!)},
              `line ${m.line}`,
            );
      const mends = fixes
        .filter(fix => fix.code === m.code && fix.from === m.from)
        .map(fix => h('button', {type: 'button', class: 'fix', onclick: () => editor().mend(fix)}, fix.title));
      return h(
        'article',
        {class: `message ${m.severity}`},
        h('p', {class: 'what'}, ...prose(m.message)),
        m.reason && h('p', {}, ...prose(m.reason)),
        m.help && h('p', {class: 'help'}, ...prose(m.help)),
        h(
          'p',
          {class: 'muted'},
          place,
          ' ',
          m.code &&
            h(
              'button',
              {
                type: 'button',
                class: 'link',
                'aria-label': `What ${m.code} means`,
                onclick: () => void explain(m.code, asker),
              },
              m.code,
            ),
          ' ',
          ...mends,
        ),
      );
    }),
    sorted.length > most ? h('p', {class: 'muted'}, `and ${sorted.length - most} more`) : '',
  );
}

async function explain(code: string, asker: Asker): Promise<void> {
  const answer = await asker.ask<{title: string; explanation: string; wrong: string; right: string}>({
    do: 'explain',
    code,
  });
  if (!answer.ok) return;
  dialog(
    `${code}: ${answer.title}`,
    [
      ...answer.explanation.split(/\n\s*\n/).map(part => h('p', {}, ...prose(part))),
      answer.wrong && h('h3', {}, 'Wrong'),
      answer.wrong && h('pre', {}, answer.wrong),
      answer.right && h('h3', {}, 'Right'),
      answer.right && h('pre', {}, answer.right),
    ].filter(Boolean) as Node[],
  );
}
