/** How the lines of a file end. In the page they end with \n, as editor and session count; a file keeps its own. */
export type Ends = '\n' | '\r\n';

export interface Lines {
  text: string;
  ends: Ends;
}

/** A file with both ends is written with the one that most of its lines have. */
export function linesOf(file: string): Lines {
  const all = file.split('\n').length - 1,
    both = file.split('\r\n').length - 1;
  return {text: file.replace(/\r\n?/g, '\n'), ends: 2 * both > all ? '\r\n' : '\n'};
}

export const fileOf = ({text, ends}: Lines): string => (ends === '\n' ? text : text.replaceAll('\n', ends));

/** Whether a file comes back as it was where nothing is changed. */
export const endsAlike = (file: string): boolean => fileOf(linesOf(file)) === file;
