// The formulas of the documents. They are written there as one reads them in a terminal, ∂L/∂q' and M⁻¹; here they
// become the LaTeX that KaTeX sets. A sign that is not listed, or what KaTeX does not understand, is an error: no
// formula is left unset.
import katex from 'katex';

const superscripts = new Map(
  [...'⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿᵀ⁽⁾ᵏⁱ'].map((sign, i) => [sign, [...'0123456789+-n', '\\mathsf{T}', '(', ')', 'k', 'i'][i]]),
);
const subscripts = new Map([...'₀₁₂₃₄₅₆₇₈₉₊₋ᵢⱼₖₙ'].map((sign, i) => [sign, [...'0123456789+-ijkn'][i]]));
const greek = {
  α: 'alpha',
  β: 'beta',
  γ: 'gamma',
  δ: 'delta',
  ε: 'varepsilon',
  ζ: 'zeta',
  η: 'eta',
  θ: 'theta',
  κ: 'kappa',
  λ: 'lambda',
  μ: 'mu',
  ν: 'nu',
  ξ: 'xi',
  π: 'pi',
  ρ: 'rho',
  σ: 'sigma',
  τ: 'tau',
  φ: 'varphi',
  χ: 'chi',
  ψ: 'psi',
  ω: 'omega',
  Γ: 'Gamma',
  Δ: 'Delta',
  Θ: 'Theta',
  Λ: 'Lambda',
  Ξ: 'Xi',
  Π: 'Pi',
  Φ: 'Phi',
  Ψ: 'Psi',
  Ω: 'Omega',
};
const signs = {
  '·': '\\cdot',
  '−': '-',
  '–': '-',
  '±': '\\pm',
  '∓': '\\mp',
  '≤': '\\le',
  '≥': '\\ge',
  '≈': '\\approx',
  '≠': '\\ne',
  '→': '\\to',
  '∞': '\\infty',
  '∫': '\\int',
  Σ: '\\sum',
  '∂': '\\partial',
  '∇': '\\nabla',
  '½': '\\tfrac{1}{2}',
  '¼': '\\tfrac{1}{4}',
  '×': '\\times',
  '⌈': '\\lceil',
  '⌉': '\\rceil',
  '⌊': '\\lfloor',
  '⌋': '\\rfloor',
  ℒ: '\\mathcal{L}',
  '𝒟': '\\mathcal{D}',
  '𝓡': '\\mathcal{R}',
  '…': '\\ldots',
  '§': '\\S ',
  '{': '\\{',
  '}': '\\}',
  '|': '|',
  '∘': '\\circ',
  '∈': '\\in',
  '⇒': '\\Rightarrow',
  '∝': '\\propto',
  '‖': '\\|',
  '*': '\\cdot',
  '%': '\\%',
  '\uE003': '\\ne',
};
const accents = {'\u0307': 'dot', '\u0308': 'ddot', '\u0302': 'hat', '\u0303': 'tilde', '\u0304': 'bar'};
const functions = new Set(['sin', 'cos', 'tan', 'exp', 'ln', 'log', 'min', 'max', 'det', 'tr']);
const operatorNames = new Set(['diag', 'rank', 'sign', 'Fix', 'fix', 'tr']);
const smallWords = new Set(['at', 'on', 'to', 'in', 'or', 'of', 'is', 'by', 'it', 'no']);

// A letter with its accents, primes and indices: what may stand above or below the line of a derivative.
const atom = "\\p{L}[\\u0300-\\u036f]*(?:_\\{[^}]*\\}|_[\\p{L}0-9]+)?[₀-₉]*'*";
const derivative = new RegExp(`(∂²?|(?<![\\p{L}_])d)(${atom})?/((?:∂${atom})+|dt)(?![\\p{L}])`, 'gu');

export class FormulaError extends Error {}

// ------------------------------------------------------------------------------------------------------ text to LaTeX

class Reader {
  constructor(text) {
    this.signs = [...text];
    this.at = 0;
  }
  get next() {
    return this.signs[this.at];
  }
  take() {
    return this.signs[this.at++];
  }
  takeWhile(test) {
    let text = '';
    while (this.at < this.signs.length && test(this.next)) text += this.take();
    return text;
  }
  takeGroup(open, close) {
    // after `open`, up to the `close` that belongs to it
    let depth = 1,
      text = '';
    while (this.at < this.signs.length) {
      const sign = this.take();
      if (sign === open) ++depth;
      if (sign === close && --depth === 0) return text;
      text += sign;
    }
    throw new FormulaError(`${open} is not closed`);
  }
}

const isLetter = sign =>
  /^\p{L}$/u.test(sign) && !superscripts.has(sign) && !subscripts.has(sign) && !(sign in signs);
const isMark = sign => sign in accents;

export function latexOf(text) {
  const reader = new Reader(text.replaceAll('≠', '\uE003').normalize('NFD'));
  let latex = '';
  while (reader.at < reader.signs.length) latex += piece(reader);
  return tidy(latex);
}

// Thin spaces stand between factors alone; words that follow each other are one text.
function tidy(latex) {
  const names = 'cdot|pm|mp|le|ge|approx|ne|to|sim|in|sum|int|partial|nabla|sin|cos|tan|exp|ln|log|min|max|det';
  const operator = String.raw`(?:[=+<>(\[,;:/-]|\\(?:${names}|(?:sum|int)\s*_\{[^{}]*\})(?![a-z]))`;
  const words = /(\\text\{[^{}]*)\}\\, \\text\{/;
  while (words.test(latex)) latex = latex.replace(words, '$1 ');
  return latex
    .replace(new RegExp(`(${operator})\\s*\\\\, `, 'g'), '$1 ')
    .replace(/\\, (?=\s*(?:[=+<>,;:)\]/-]|\\(?:cdot|pm|mp|le|ge|approx|ne|to|sim)(?![a-z])))/g, ' ')
    .replace(/(\\text\{[^{}]*\})\\, /g, '$1\\;')
    .replace(/\\, (\\text\{)/g, '\\;$1')
    .trim();
}

function piece(reader) {
  const sign = reader.next;
  if (sign === ' ') return spaces(reader);
  if (sign === '\uE000') return fraction(reader);
  if (isLetter(sign)) return letters(reader);
  reader.take();
  if (superscripts.has(sign)) return scripts(reader, sign, superscripts, '^');
  if (subscripts.has(sign)) return scripts(reader, sign, subscripts, '_');
  if (sign === '√') return `\\sqrt{${argument(reader)}}`;
  if (sign === '^' || sign === '_') return sign + script(reader);
  if (sign === "'") return primes(reader);
  if (sign === '(' && reader.signs.indexOf(')', reader.at) > 0) return bracketed(latexOf(reader.takeGroup('(', ')')));
  if (sign in signs) return signs[sign] + ' ';
  if (/^[0-9+\-=<>()[\],.;:/!~]$/.test(sign)) return sign === '~' ? '\\sim ' : sign;
  throw new FormulaError(`no LaTeX for ${JSON.stringify(sign)} (U+${sign.codePointAt(0).toString(16)})`);
}

const bracketed = latex => (latex.includes('\\frac') ? `\\left(${latex}\\right)` : `(${latex})`);

function primes(reader) {
  let text = '\\prime'.repeat(1 + reader.takeWhile(s => s === "'").length);
  while (superscripts.has(reader.next)) text += superscripts.get(reader.take());
  return `^{${text}}`;
}

function spaces(reader) {
  return reader.takeWhile(s => s === ' ').length > 1 ? '\\;\\; ' : '\\, ';
}

// \uE000 numerator \uE001 denominator \uE002: see typeset().
function fraction(reader) {
  reader.take();
  const above = reader.takeWhile(s => s !== '\uE001');
  reader.take();
  const below = reader.takeWhile(s => s !== '\uE002');
  reader.take();
  return `\\frac{${latexOf(above)}}{${latexOf(below)}}`;
}

function scripts(reader, sign, table, mark) {
  let text = table.get(sign);
  while (table.has(reader.next)) text += table.get(reader.take());
  return `${mark}{${text}}`;
}

function script(reader) {
  if (reader.next === '{') {
    reader.take();
    return `{${latexOf(reader.takeGroup('{', '}'))}}`;
  }
  if (reader.next === '(') {
    reader.take();
    return `{(${latexOf(reader.takeGroup('(', ')'))})}`;
  }
  const text = reader.takeWhile(s => isLetter(s) || /[0-9]/.test(s) || isMark(s));
  if (text === '') throw new FormulaError('nothing stands in an index');
  const word = /^[a-z]{3,}$/.test(text) && !/^[txyz]+$/.test(text); // q_max; φ_txx is a derivative
  return word ? `{\\mathrm{${text}}}` : `{${[...text].map(letter).join('')}}`;
}

const letter = sign => (sign in greek ? `\\${greek[sign]} ` : sign);

function argument(reader) {
  if (reader.next === '(') {
    reader.take();
    return latexOf(reader.takeGroup('(', ')'));
  }
  let text = reader.take() + reader.takeWhile(isMark);
  text += reader.takeWhile(s => subscripts.has(s) || /[0-9]/.test(s));
  return latexOf(text);
}

// One letter is a symbol, two are a product, three are a word or a function.
function letters(reader) {
  const from = reader.at;
  const run = reader.takeWhile(s => isLetter(s) || (s === '’' && reader.at > from));
  if (!isMark(reader.next) && /^[A-Za-z’]+$/.test(run)) {
    if (functions.has(run) && run !== 'tr') return `\\${run} `;
    if (operatorNames.has(run)) return `\\operatorname{${run}}`;
    if (run.length >= 3 || smallWords.has(run)) return `\\text{${run}}`;
  }
  reader.at = from;
  const sign = reader.take();
  let latex = letter(sign);
  while (isMark(reader.next)) latex = `\\${accents[reader.take()]}{${latex.trim()}}`;
  return latex;
}

// --------------------------------------------------------------------------------------------------------- blocks

// A line may break at a sign between terms, but not within short brackets: those become groups.
function unbroken(latex) {
  let result = '',
    at = 0;
  while (at < latex.length) {
    if (latex[at] !== '(' || /\\(left|right|bigl?|Bigl?)$/.test(result)) {
      result += latex[at++];
      continue;
    }
    let end = at,
      depth = 0;
    do {
      if (latex[end] === '(') ++depth;
      else if (latex[end] === ')') --depth;
      ++end;
    } while (depth > 0 && end < latex.length);
    const group = latex.slice(at, end),
      signs = group.replace(/\\[a-z]+|[{}^_\s\\]/g, '').length;
    const braces = (group.match(/\{/g) ?? []).length - (group.match(/\}/g) ?? []).length;
    if (depth === 0 && braces === 0 && signs <= 22 && !/\\right/.test(group)) {
      result += `\\mathopen{}{${group}}`;
      at = end;
    } else result += latex[at++];
  }
  return result;
}

// A formula of several lines goes on with the sign of its next term, as in books; KaTeX breaks after signs by itself.
function brokenBeforeSigns(latex) {
  const isBinary = before => !/(^|[=(<>,&]|\\(leq?|geq?|approx|equiv|cdot|times|quad|pm|in))\s*$/.test(before);
  let depth = 0;
  return latex.replace(/\\(left|right|begin|end)(?![a-z])|\\.|[{}]|(?<=\s)[-+−](?=\s)/gu, (part, pair, at) => {
    if (part === '{' || pair === 'left' || pair === 'begin') ++depth;
    else if (part === '}' || pair) --depth;
    else if (!part.startsWith('\\') && depth === 0 && isBinary(latex.slice(0, at)))
      return `\\allowbreak ${part}\\nobreak `;
    return part;
  });
}

export function katexHtml(latex, where) {
  try {
    return katex.renderToString(`\\displaystyle ${unbroken(brokenBeforeSigns(latex))}`, {
      throwOnError: true,
      strict: 'error',
      output: 'htmlAndMathml',
    });
  } catch (error) {
    throw new FormulaError(`${where}: the formula ${latex} does not render: ${error.message}`);
  }
}

const onlyWords = text => /^[a-z’]+( [a-z’]+)+$/.test(text);

function typeset(text, where) {
  try {
    if (onlyWords(text)) return `<span class="said">${text}</span>`;
    const marked = text
      .normalize('NFC')
      .replace(derivative, (all, d, what, below) => `\uE000${d}${what ?? ''}\uE001${below}\uE002`);
    return katexHtml(latexOf(marked), where);
  } catch (error) {
    throw error instanceof FormulaError ? new FormulaError(`${where}: ${error.message}: ${text}`) : error;
  }
}

// Rows of [ … ] or | … | over each other are matrices.
function matrixLatex(lines) {
  const rows = lines.map(line => [...line.matchAll(/[[|]\s*(.*?)\s*[\]|]/gu)].map(group => group[1].split(/\s{2,}/)));
  const between = lines.map(line => line.split(/[[|].*?[\]|]/u).map(part => part.trim()));
  let latex = '';
  rows[0].forEach((_, g) => {
    const sign = between.map(parts => parts[g]).find(part => part !== '');
    const cell = text => latexOf(text.replace(/ or /g, ' or '));
    const cells = rows.map(row => row[g].map(cell).join(' & ')).join(' \\\\ ');
    latex += `${sign ? latexOf(sign) : ''}\\begin{bmatrix}${cells}\\end{bmatrix}`;
  });
  return latex;
}

export function formulaBlock(text, where) {
  const lines = text.split('\n').filter(line => line.trim() !== '');
  if (lines.length > 1 && lines.every(line => /^\s*[[|].*[\]|]\s*$/u.test(line)))
    return `<div class="formula">${katexHtml(matrixLatex(lines), where)}</div>\n`;
  return lines
    .map(line => {
      const parts = line
        .trim()
        .split(/\s{3,}/)
        .map(part => `<span class="part">${typeset(part, where)}</span>`);
      return `<div class="${/∂|d\/dt/.test(line) ? 'formula tall' : 'formula'}">${parts.join(' ')}</div>\n`;
    })
    .join('');
}
