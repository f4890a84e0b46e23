import {h} from '../dom';

/**
 * The little Markdown that hovers are written in: paragraphs, fenced code, `code`, **bold**, *emphasis*; nothing else
 * is markup.
 */
export function markdown(text: string): HTMLElement {
  const out = h('div', {class: 'markdown'});
  for (const part of text.split(/(```[\s\S]*?```)/)) {
    if (part.startsWith('```')) out.append(h('pre', {}, part.replace(/^```\w*\n?/, '').replace(/\n?```$/, '')));
    else
      for (const paragraph of part.split(/\n\s*\n/))
        if (paragraph.trim()) out.append(h('p', {}, ...inline(paragraph.trim())));
  }
  return out;
}

function inline(text: string): Node[] {
  return text
    .split(/(`[^`]*`|\*\*[^*]+\*\*|\*[^*\s][^*]*\*)/)
    .filter(Boolean)
    .map(part => {
      if (part.startsWith('`')) return h('code', {}, part.slice(1, -1));
      if (part.startsWith('**')) return h('b', {}, part.slice(2, -2));
      if (/^\*[^*\s]/.test(part)) return h('i', {}, part.slice(1, -1));
      return document.createTextNode(part.replace(/ {2}\n/g, '\n'));
    });
}
