// Sentences as a book sets them: symbols with what is lowered and raised, variables in italics, powers of ten,
// quotation marks. Names of programs stand in code and are left alone.

const raised = html =>
  html
    .replace(
      /((?<![\p{L}\p{N}_∂δ])(?:[∂δd]?\p{L}[\u0300-\u036f]*'*|∂)|[)\]])_(\{[^}]*\}|[\p{L}0-9]{1,3})(?![\p{L}0-9_])/gu,
      (all, base, index) => `${base}<sub>${index.replace(/[{}]/g, '')}</sub>`,
    )
    .replace(/∂_(\p{L})(?![\p{L}0-9_])/gu, '∂<sub>$1</sub>')
    .replace(
      /(?<=[\p{L}\p{N})\]>])\^(\{[^}]*\}|[-−]?[\p{L}0-9]{1,3}|\([^()]{1,8}\))(?![\p{L}0-9])/gu,
      (all, power) => `<sup>${power.replace(/[{}]/g, '')}</sup>`,
    )
    .replace(
      /((?<![\p{L}\p{N}])[∂δ]?\p{L}[\u0300-\u036f]*|(?<=\p{L}\([\p{L}\d,\s]{1,8})\))('+)(?![\p{L}'])/gu,
      (all, base, primes) => base + '′'.repeat(primes.length),
    )
    .replace(/(?<=<\/sub>)'+/gu, primes => '′'.repeat(primes.length));

/** 2.9e-03 as 2.9 · 10⁻³, 1e-12 as 10⁻¹², 0.0e+00 as 0 */
const powersOfTen = html =>
  html.replace(/(?<![\p{L}\p{N}_.])(\d+(?:\.\d+)?)e([-+]?)(\d{1,3})(?![\p{L}\p{N}_])/gu, (...match) => {
    const [, mantissa, sign, digits] = match;
    if (Number(mantissa) === 0) return '0';
    const power = `10<sup>${sign === '-' ? '−' : ''}${Number(digits)}</sup>`;
    return mantissa === '1' ? power : `${mantissa} · ${power}`;
  });

/** "a" as “a”, Lagrange's as Lagrange’s. */
const quoted = html =>
  html
    .replace(/(^|[\s([/–])&quot;(?=[^\s.,;:)])/gu, '$1“')
    .replace(/&quot;/g, '”')
    .replace(/(?<=\p{L}{2})'(?=\p{L})/gu, '’');

export const prose = html => quoted(powersOfTen(raised(html)));

// What is no variable: units, initials of a person, the article, the label of a list.
const operator = /^(\s*([=+−·×/≤≥≠≈∈]|&[lg]t;)|<su[bp]>|[′₀-₉²³ᵀ(,;.)])/u;
const isUnit = (before, letter, after) =>
  ('smNJKVAWgh'.includes(letter) && /(\d|[(/][mNJ])[\s\u00a0]$|(rad|m|N|J)\/$/.test(before) && !/^<|^′/.test(after)) ||
  (letter === 'N' && /^(\)| m\))/.test(after) && before.endsWith('(')) ||
  (/[NJW]/.test(letter) && /^\/(m|rad|s|kg)(?![\p{L}\p{N}])/u.test(after)) ||
  (/^\/(s|kg|m)(?![\p{L}<])/u.test(after + ' ') && /(\d|^)\s?$/.test(before));
const isInitial = (before, letter, after) =>
  /\p{Lu}/u.test(letter) &&
  /^\.[\s-]\p{Lu}/u.test(after) &&
  /(^|[,;(]\s?|(?<![\p{L}\p{N}])\p{Lu}\.[\s-]|\b(and|by)\s)$/u.test(before);
const isArticle = (before, letter, after) =>
  letter === 'a' && (before || after)
    ? !(operator.test(after) || /(\p{L}\(|[=+−·×/]\s?)$/u.test(before))
    : letter === 'A' && /(^|[.:;!?(“])\s*$/u.test(before) && /^(\s\p{L}{2}|\s*$)/u.test(after) &&
      !/^\s(is|has|and|or)\s/.test(after);
const isLabel = (before, letter, after) => /[a-g]/.test(letter) && /(^|\s)\($/.test(before) && /^\)\s/.test(after);
const isNoVariable = (before, letter, after) =>
  [isUnit, isInitial, isArticle, isLabel].some(is => is(before, letter, after)) ||
  /^\.\d/.test(after) ||
  /[ℒℋ𝒟ℝℂℤΣΠΔΓΛΩΦΨΘΞ]/u.test(letter) ||
  /<[^>]*$/.test(before);

// A letter that belongs to no word, with the sign of a variation or differential before it.
const letterAlone = new RegExp(
  [
    /(?<![\p{Lu}\p{Ll}\p{Nd}_’'&;\uE000])/u,
    /(δ|d(?=[\p{Script=Greek}txyzqpsvwhA-Z])|\p{Script=Greek}(?=\p{Script=Greek}))?/u,
    /([\p{Lu}\p{Ll}][\u0300-\u036f]*)/u,
    /(?![\p{Lu}\p{Ll}\p{Nd}_'’\uE001]|-\p{L}|\+\+)/u,
  ]
    .map(part => part.source)
    .join(''),
  'gu',
);

/**
 * Variables, a letter by itself (δφ, dt, λψ), indices of one or two letters and those of derivatives (φ_txx): in
 * italics, as formulas have them.
 */
export const italic = html =>
  html
    .replace(/<su([bp])>(\p{L}{1,2}|[txyz]{3})<\/su\1>/gu, '<su$1>\uE000$2\uE001</su$1>')
    .replace(
      letterAlone,
      (all, variation, letter, at, whole) =>
        isNoVariable(whole.slice(0, at), letter, whole.slice(at + all.length)) ? all : `\uE000${all}\uE001`,
    )
    .replaceAll('\uE001\uE000', '')
    .replaceAll('\uE000', '<i>')
    .replaceAll('\uE001', '</i>');
