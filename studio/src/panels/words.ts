/** Numbers and units as a book prints them: 5e-16 is 5·10⁻¹⁶, m/s^2 is m/s². */
export function numbers(text: string): string {
  return text
    .replace(
      /(?<![\w.])(-?\d+(?:\.\d+)?)e([+-]?)0*(\d+)/g,
      (_, mantissa: string, sign: string, exponent: string) =>
        `${mantissa === '1' ? '' : mantissa + '·'}10${raised((sign === '-' ? '-' : '') + exponent)}`,
    )
    .replace(/(?<=\p{L})\^(-?\d)(?!\d)/gu, (_, exponent: string) => raised(exponent))
    .replace(/(?<![\w.)])-(?=\d)/g, '−');
}

export const raised = (digits: string): string =>
  [...digits].map(c => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]).join('');

export function unitText(unit: string): string {
  return unit === 'deg'
    ? '°'
    : unit.replace(/\^\(?(-?\d+)\)?/g, (_, exponent: string) => raised(exponent)).replace(/ /g, '\u2009');
}

/** The modes to choose from; one that is chosen is among them, whatever is known of the model. */
export const modeOptions = (modes: string[], chosen: string): HTMLOptionElement[] => [
  new Option('as the motion is', '', false, !chosen),
  ...(chosen && !modes.includes(chosen) ? [...modes, chosen] : modes).map(
    one => new Option(one, one, false, one === chosen),
  ),
];

/** The name as formulas write it: θ1' is θ₁′. Marks of differentiation stay primes, which any face has. */
export function pretty(name: string): string {
  return name
    .replace(
      /(\p{L})(\d+)(?![\d.])/gu,
      (_, letter: string, digits: string) => letter + [...digits].map(d => '₀₁₂₃₄₅₆₇₈₉'[Number(d)]).join(''),
    )
    .replace(/''/g, '″')
    .replace(/'/g, '′')
    .replace(/(?<![\w.)])-(?=\d)/g, '−');
}
