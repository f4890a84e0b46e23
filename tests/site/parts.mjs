// The parts of the site's program that must refuse what they do not understand, and those with an answer that is known.
import {existsSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {FormulaError, formulaBlock, katexHtml, latexOf} from '../../site/source/formula.mjs';
import {Highlighter} from '../../site/source/highlight.mjs';
import {Documents, slug} from '../../site/source/markdown.mjs';
import {benchmarkPlots, seconds, tables} from '../../site/source/plots.mjs';
import {relative} from '../../site/source/layout.mjs';
import {fragmentOf, textOfFragment} from '../../site/source/studio.mjs';
import {italic, prose} from '../../site/source/prose.mjs';
import {one, parseXml, textOf} from '../../site/source/xml.mjs';

const refuses = (action, kind) => {
  try {
    action();
    return false;
  } catch (error) {
    return kind ? error instanceof kind : true;
  }
};

export async function checkParts(check, root) {
  const squeezed = text => latexOf(text).replace(/\s/g, '');
  check('primes and powers', squeezed("q'' + x²") === 'q^{\\prime\\prime}+x^{2}', squeezed("q'' + x²"));
  check(
    'indices',
    squeezed('φ_xxt p_0 λ_rod') === '\\varphi_{xxt}\\,p_{0}\\,\\lambda_{\\mathrm{rod}}',
    squeezed('φ_xx p_0 λ_rod'),
  );
  const sentence = italic(prose('D(φ_tx) and D(φ_txx) of p, λ_rod'));
  check(
    'indices in sentences are in italics as those of formulas are',
    sentence === '<i>D</i>(<i>φ</i><sub><i>tx</i></sub>) and <i>D</i>(<i>φ</i><sub><i>txx</i></sub>) of <i>p</i>, ' +
      '<i>λ</i><sub>rod</sub>',
    sentence,
  );
  check('dots are those of the letter', squeezed('ξ̈ + ṗ') === '\\ddot{\\xi}+\\dot{p}', squeezed('ξ̈ + ṗ'));
  check('not equal is not equal', squeezed('a ≠ b') === 'a\\neb', squeezed('a ≠ b'));
  check('a root holds its bracket', squeezed('√(1 − x)') === '\\sqrt{1-x}', squeezed('√(1 − x)'));
  const set = formulaBlock("d/dt ∂L/∂q' − ∂L/∂q = 0", 'x.md:1');
  check(
    'derivatives are fractions',
    (set.match(/class="mfrac"/g) ?? []).length === 3,
    (set.match(/class="mfrac"/g) ?? []).length,
  );
  check('a matrix is one', formulaBlock('[ M  −Aᵀ ]\n[ A   0 ]', 'x.md:1').includes('mtable'));
  const long = katexHtml('a + b - \\left(c + d\\right) = - e + f', 'x');
  const lines = long.split('class="katex-base"').slice(1);
  check(
    'lines are broken before signs between terms',
    JSON.stringify(lines.map(part => part.replace(/^>|<[^>]*(>|$)/g, ''))) ===
      JSON.stringify(['a', '+b', '−(c+d)=', '−e', '+f']),
    lines.map(part => part.replace(/^>|<[^>]*(>|$)/g, '')),
  );
  check(
    'an unknown sign is refused',
    refuses(() => formulaBlock('a ☃ b', 'x.md:1'), FormulaError),
  );
  check(
    'what KaTeX does not know is refused',
    refuses(() => katexHtml('\\nosuchcommand x', 'x'), FormulaError),
  );
  check(
    'a bracket that stays open is refused',
    refuses(() => formulaBlock('x^{2', 'x.md:1'), FormulaError),
  );

  const highlighter = new Highlighter(join(root, 'editors/vscode/syntaxes/lag.tmLanguage.json'));
  const line = highlighter.html('param m = 1 kg # <b>');
  check(
    'words and comments are marked',
    line.includes('<span class="word">param</span>') && line.includes('<span class="comment"># &lt;b&gt;</span>'),
    line,
  );
  check(
    'no letter of a model is lost',
    /^[\s\S]*$/.test(line) && stripped(highlighter.html(sample)) === sample,
    stripped(highlighter.html(sample)),
  );

  const documents = new Documents(highlighter, target => target);
  check(
    'an unknown kind of block is refused',
    refuses(() => documents.render('# t\n\n```what\nx\n```\n', 'x.md')),
  );
  check(
    'an indented block is refused',
    refuses(() => documents.render('# t\n\n    x\n', 'x.md')),
  );
  const page = documents.render("# Title\n\n## One, two\n\nthe h_E of q'' and `h_E`\n", 'x.md');
  check(
    'symbols within sentences are set, code is not',
    page.html.includes('h<sub>E</sub> of q′′') && page.html.includes('<code>h_E</code>'),
    page.html,
  );
  const theory = text => documents.render(`# t\n\n${text}\n`, 'docs/theory/x.md').html.replace(/<\/?p>|\n/g, '');
  for (const [text, html] of [
    ['with h_E of q\'\' and δu', 'with <i>h</i><sub><i>E</i></sub> of <i>q</i>′′ and <i>δu</i>'],
    ['A value u(a) of a string, 2 m long', 'A value <i>u</i>(<i>a</i>) of a string, 2 m long'],
    ['the rows A q = b (D. E. Knuth) at 3 rad/s', 'the rows <i>A</i> <i>q</i> = <i>b</i> (D. E. Knuth) at 3 rad/s'],
    ['Lagrange\'s "to reach", 2.9e-03 and 1e-12', 'Lagrange’s “to reach”, 2.9 · 10<sup>−3</sup> and 10<sup>−12</sup>'],
    ['A is singular: N/m for λ', '<i>A</i> is singular: N/m for <i>λ</i>'],
    ['d/dt of M⁻¹ and Aᵀλ', '<i>d</i>/<i>dt</i> of <i>M</i>⁻¹ and <i>A</i>ᵀ<i>λ</i>'],
  ])
    check(`a sentence is set as in a book: ${text}`, theory(text) === html, theory(text));
  check(
    'anchors are those of the links',
    page.headings[0].id === 'one-two' &&
      slug('What is conserved, and what rests') === 'what-is-conserved-and-what-rests',
  );

  check(
    'times are read',
    seconds('3.36 µs') === 3.36e-6 &&
      seconds('27.6 ns') === 2.76e-8 &&
      seconds('13.2 ms') === 0.0132 &&
      seconds('about n') === null,
  );
  check('tables are read', tables('| a | b |\n|---|---|\n| 1 | 2 |\n')[0].rows[0][1] === '2');
  const plots = benchmarkPlots(readFileSync(join(root, 'docs/benchmarks.md'), 'utf8'));
  check(
    'plots have the points of the tables',
    Object.values(plots).every(plot => plot.series.every(series => series.points.every(p => p[0] > 0 && p[1] > 0))),
  );
  check(
    'a table that is gone is missed',
    refuses(() => benchmarkPlots('# nothing\n')),
  );

  check(
    'addresses are relative',
    relative('a/b.html', 'c/d.html#e') === '../c/d.html#e' &&
      relative('a/b.html', 'a/c.html') === 'c.html' &&
      relative('index.html', 'a/b.html') === 'a/b.html',
  );
  check('a model comes back from its link', textOfFragment(fragmentOf(sample, 's')) === sample);
  await checkSharing(check, root);
  const xml = parseXml('<a x="1 &amp; 2"><b>p &lt; q</b>r</a>');
  check('XML is read', xml.attributes.x === '1 & 2' && textOf(one(xml, 'b')) === 'p < q' && textOf(xml) === 'p < qr');
  check('the lock names no registry', !/"resolved"/.test(readFileSync(join(root, 'site/package-lock.json'), 'utf8')));
  check('the site is not the place of Node’s packages', !existsSync(join(root, 'site/source/node_modules')));
}

// The studio reads the links of the site, and the site those that the studio writes.
async function checkSharing(check, root) {
  const {build} = createRequire(join(root, 'site/package.json'))('esbuild'),
    entry = join(root, 'studio/src/tools/share.ts');
  const {outputFiles} = await build({
    entryPoints: [entry],
    bundle: true,
    format: 'esm',
    write: false,
    logLevel: 'silent',
  });
  const share = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString('base64')}`);
  const read = await share.decodeShared(fragmentOf(sample, 's').slice(2));
  check('the studio reads the links of the site', read?.text === sample && read.name === 's', read);
  check('a broken link is none', (await share.decodeShared(fragmentOf(sample, 's').slice(2, -4))) === null);
  check('the site reads those of the studio', textOfFragment(await share.encodeShared({text: sample})) === sample);
}

const stripped = html =>
  html
    .replace(/<[^>]*>/g, '')
    .replaceAll('&lt;', '<')
    .replaceAll('&gt;', '>')
    .replaceAll('&quot;', '"')
    .replaceAll('&amp;', '&');

const sample =
  'system s "θ & <b> – ½"\nparam m = 1 kg, a = 2 [m/s^2]  # [ open\ncoord θ1 : angle\n' +
  "L = 1/2 m θ1'^2 - m a cos(θ1)\nexpect equation m θ1'' = 0 \"€\n";
