// The documents of the repository as HTML: what each kind of block becomes, anchors of headings, links to other pages.
import MarkdownIt from 'markdown-it';
import {escape} from './highlight.mjs';
import {formulaBlock} from './formula.mjs';
import {italic, prose} from './prose.mjs';

export const slug = text =>
  text
    .toLowerCase()
    .replace(/[^\p{L}\p{N}\s_-]/gu, '')
    .trim()
    .replace(/\s/g, '-');

// `sh install`: the second word says how tests/documents treats a block; a reader of the site need not know.
const plainKinds = new Set(['diagram', 'shape', 'usage', 'python', 'toml', 'lua', 'vim', 'elisp', 'cmake', 'cpp']);

// A block may be set in as a whole.
const dedented = text => {
  const margins = text
    .split('\n')
    .filter(line => line.trim() !== '')
    .map(line => line.match(/^ */)[0].length);
  return text
    .split('\n')
    .map(line => line.slice(Math.min(...margins)))
    .join('\n');
};

export class Documents {
  constructor(highlighter, linkOf, {studioLink = () => null, titleOf = () => null} = {}) {
    this.titleOf = titleOf;
    this.highlighter = highlighter;
    this.linkOf = linkOf; // (target, document) → address beside the page; null: none; or throws
    this.studioLink = studioLink;
    this.md = new MarkdownIt({html: true, typographer: false});
    const rules = this.md.renderer.rules;
    rules.fence = (tokens, i, options, env) => this.fence(tokens[i], env);
    rules.text = (tokens, i, options, env) => {
      const html = prose(escape(tokens[i].content));
      return env.file.startsWith('docs/theory') ? italic(html) : html;
    };
    rules.code_block = (tokens, i, options, env) => {
      throw new Error(
        `${env.file}:${tokens[i].map[0] + 1}: an indented block says not what it is; write \`\`\`sh, lag, formula, …`,
      );
    };
    rules.table_open = () => '<div class="scroll"><table>\n';
    rules.table_close = () => '</table></div>\n';
    rules.th_open = (tokens, i) =>
      tokens[i + 1].content === '' ? '<td class="blank">' : `<th scope="col"${align(tokens[i])}>`;
    rules.th_close = (tokens, i) => (tokens[i - 1].content === '' ? '</td>' : '</th>');
    this.md.core.ruler.push('places', state => this.places(state));
  }

  // Headings get the anchors that the documents link to; links and pictures the addresses of the site.
  places(state) {
    const {env} = state,
      used = new Set();
    state.tokens.forEach((token, i) => {
      if (token.type === 'heading_open') {
        const text = state.tokens[i + 1].children
          .filter(t => t.type === 'text' || t.type === 'code_inline')
          .map(t => t.content)
          .join('');
        let id = slug(text),
          n = 1;
        while (used.has(id)) id = `${slug(text)}-${n++}`;
        used.add(id);
        token.attrSet('id', id);
        env.headings.push({level: Number(token.tag[1]), text, id});
      }
      (token.children ?? []).forEach((child, k, children) => {
        if (child.type === 'link_open' && /^[\w/]+\.md$/.test(children[k + 1]?.content ?? '')) {
          const title = this.titleOf(child.attrGet('href'), env);
          if (title) children[k + 1].content = title;
        }
        if (child.type === 'link_open') this.lead(children, k, env);
        if (child.type === 'image') child.attrSet('src', this.linkOf(child.attrGet('src'), env));
      });
    });
  }

  // A link to what is no page of the site becomes its text.
  lead(children, k, env) {
    const address = this.linkOf(children[k].attrGet('href'), env);
    if (address !== null) return children[k].attrSet('href', address);
    const close = children.findIndex((child, i) => i > k && child.type === 'link_close');
    for (const child of [children[k], children[close]]) child.tag = 'span';
    children[k].attrs = [];
  }

  fence(token, env) {
    const [kind] = token.info.trim().split(/\s+/),
      text = dedented(token.content.replace(/\n$/, ''));
    const where = `${env.file}:${token.map[0] + 1}`;
    env.blocks = (env.blocks ?? 0) + 1;
    switch (kind) {
      case 'lag':
        return this.lag(text, token.info.trim() === 'lag');
      case 'formula':
        return formulaBlock(text, where);
      case 'console':
        return `<pre class="console"><code>${consoleHtml(text)}</code></pre>\n`;
      case 'sh':
        return `<pre class="console"><code>${remarked(escape(text))}</code></pre>\n`;
      default:
        if (!plainKinds.has(kind)) throw new Error(`${where}: a block of the unknown kind "${kind}"`);
        return `<pre class="${kind}"><code>${escape(text)}</code></pre>\n`;
    }
  }

  lag(text, whole) {
    const link = whole && this.studioLink(text);
    const open = link ? `<a class="open" href="${link}">open in the studio</a>` : '';
    return `<div class="listing"><pre class="model"><code>${this.highlighter.html(text)}</code></pre>${open}</div>\n`;
  }

  // {html, title, headings, sections}; the title is taken from the first heading and left out of the html.
  render(text, file) {
    const env = {file, headings: []};
    const tokens = this.md.parse(text, env);
    const html = this.md.renderer.render(tokens, this.md.options, env);
    const title = env.headings[0]?.level === 1 ? env.headings[0].text : file;
    const body = html.replace(/<h1[^>]*>.*?<\/h1>\n?/s, '');
    return {
      title,
      html: body,
      headings: env.headings.filter(h => h.level > 1),
      sections: sectionsOf(tokens, title),
      blocks: env.blocks ?? 0,
    };
  }
}

const remarked = html => html.replace(/(^|\s)(#.*)$/gm, '$1<span class="comment">$2</span>');

const align = token => (token.attrGet('style') ? ` style="${token.attrGet('style')}"` : '');

export const consoleHtml = text =>
  text
    .split('\n')
    .map(line =>
      line.startsWith('$ ')
        ? `<span class="prompt">$ </span><span class="command">${escape(line.slice(2))}</span>`
        : escape(line),
    )
    .join('\n');

// What the search finds: the text below each heading.
function sectionsOf(tokens, title) {
  const sections = [{title, id: '', text: '', prose: ''}];
  tokens.forEach((token, i) => {
    if (token.type === 'heading_open' && token.tag !== 'h1')
      sections.push({title: plain(tokens[i + 1]), id: token.attrGet('id'), text: '', prose: ''});
    else if (token.type === 'inline' && tokens[i - 1]?.type !== 'heading_open') {
      sections.at(-1).text += plain(token) + ' ';
      if (tokens[i - 1]?.type === 'paragraph_open') sections.at(-1).prose += plain(token) + ' ';
    } else if (token.type === 'fence') sections.at(-1).text += token.content.replace(/\s+/g, ' ') + ' ';
  });
  return sections;
}

const plain = token =>
  (token.children ?? [])
    .map(t => (t.type === 'softbreak' ? ' ' : t.content))
    .join('')
    .replace(/\s+/g, ' ');
