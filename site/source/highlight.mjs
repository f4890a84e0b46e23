// Model text in colour, by the grammar that the editors use (editors/vscode/syntaxes/lag.tmLanguage.json): its rules
// are read here, so that a word of the language is listed once. Only what that grammar has is understood: match, begin
// and end, include.
import {readFileSync} from 'node:fs';

export const escape = text =>
  text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;').replaceAll('"', '&quot;');

// The scopes of the grammar that are shown, and the classes of style.css.
const classes = [
  ['comment', 'comment'],
  ['string', 'string'],
  ['keyword.control', 'word'],
  ['keyword.other', 'clause'],
  ['support.function', 'function'],
  ['support.type', 'unit'],
  ['constant.numeric', 'number'],
  ['constant.language', 'constant'],
];

const classOf = scope => classes.find(([prefix]) => scope?.startsWith(prefix))?.[1];

export class Highlighter {
  constructor(grammarFile) {
    const grammar = JSON.parse(readFileSync(grammarFile, 'utf8'));
    this.repository = grammar.repository;
    this.patterns = this.resolve(grammar.patterns);
  }

  resolve(patterns) {
    return patterns
      .map(pattern => (pattern.include ? this.repository[pattern.include.slice(1)] : pattern))
      .map(pattern => ({
        ...pattern,
        expression: new RegExp(pattern.match ?? pattern.begin, 'gu'),
        last: pattern.end && new RegExp(pattern.end, 'gu'),
        inner: pattern.patterns && this.resolve(pattern.patterns),
      }));
  }

  html(text) {
    return text
      .split('\n')
      .map(line => this.line(line, this.patterns))
      .join('\n');
  }

  // The rule that matches first decides; of two at the same place the one that stands first in the grammar.
  line(text, patterns) {
    let html = '',
      at = 0;
    while (at < text.length) {
      const found = first(patterns, text, at);
      if (!found) break;
      const [pattern, match] = found;
      html += escape(text.slice(at, match.index));
      let end = match.index + match[0].length;
      if (pattern.last) {
        pattern.last.lastIndex = end;
        const close = pattern.last.exec(text);
        const from = end;
        end = close ? close.index + close[0].length : text.length;
        html += escape(match[0]) + this.line(text.slice(from, end), pattern.inner);
      } else {
        html += marked(match[0], pattern.name);
      }
      if (end === at) html += escape(text[end++]);
      at = end;
    }
    return html + escape(text.slice(at));
  }
}

function first(patterns, text, at) {
  let best = null;
  for (const pattern of patterns) {
    pattern.expression.lastIndex = at;
    const match = pattern.expression.exec(text);
    if (match && match[0] !== '' && (!best || match.index < best[1].index)) best = [pattern, match];
  }
  return best;
}

function marked(text, scope) {
  const name = classOf(scope);
  return name ? `<span class="${name}">${escape(text)}</span>` : escape(text);
}
