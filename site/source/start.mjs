// The start page: a double pendulum to take hold of, what one writes and gets, and ways on.
import {escape} from './highlight.mjs';
import {katexHtml} from './formula.mjs';
import {fragmentOf} from './studio.mjs';

const shown = [
  'rattleback',
  'planetary_gear',
  'stadium_billiard',
  'kink_antikink',
  'spherical_pendulum',
  'squeezer',
  'membrane',
  'woodpecker',
];

// The model without its tests, as in the README.
const short = text =>
  text
    .split('\n')
    .filter(line => line !== '' && !/^(source|expect|claim|output|#)/.test(line) && !/^\s/.test(line))
    .join('\n');

/// The angles and their rates along the run, rounded to what a picture needs.
function trajectory(csv) {
  const [header, ...lines] = csv.trim().split(/\r?\n/),
    names = header.split(',').map(name => name.replace(/ \[.*/, '').replaceAll('"', ''));
  const columns = ['t', 'θ1', "θ1'", 'θ2', "θ2'"].map(name => {
    const at = names.indexOf(name);
    if (at < 0) throw new Error(`the trajectory of the double pendulum has no column ${name}`);
    return at;
  });
  return lines.map(line => {
    const cells = line.split(',');
    return columns.map(at => Number(Number(cells[at]).toPrecision(8)));
  });
}

export async function startPage(models, program, documents, {studio}) {
  const model = models.find(m => m.name === 'double_pendulum'),
    text = short(model.text);
  const csv = await program.written(
    'start.csv',
    'simulate',
    model.file,
    '--every',
    '20ms',
    '--no-errors',
    '--columns',
    "θ1, θ1', θ2, θ2'",
  );
  if (csv === null) throw new Error('maup simulate models/double_pendulum.lag failed');
  const state = (await program.run('simulate', model.file, '--at', '1s', '--duration', '1s')).out
    .split('\n')
    .slice(0, 5)
    .join('\n');
  const wrong = text.replace('l2 (sin θ2', 'm2 (sin θ2'),
    message = await mistake(program, wrong);
  const d = model.derivation,
    pictures = shown.map(name => models.find(m => m.name === name)).filter(m => m?.picture);
  const html = `<section class="hero">
<div class="words">
<h1>Lagrangian mechanics from a text file</h1>
<p class="lead">Write where the masses are. <code>maup</code> derives the equations of motion, certifies
them by independent routes, and runs them to the last digits of double precision.</p>
<p class="actions"><a class="button main" href="manual/getting_started.html">Get started</a>
<a class="button" href="models/index.html">${models.length} models</a>
${studio ? '<a class="button" href="studio/index.html">Open the studio</a>' : ''}</p>
</div>
<figure id="pendulum">
<svg viewBox="-2.1 -1.35 4.2 3.5" aria-label="A double pendulum in motion. Its two bobs can be dragged." role="group">
<g class="trail"></g>
<path class="ground" d="M-.2 0H.2M-.2 0l.07-.08M-.1 0l.07-.08M0 0l.07-.08M.1 0l.07-.08"/>
<path class="rods"/>
<circle class="pivot" r=".035"/>
<circle class="bob first" r=".11" tabindex="0" role="slider"
 aria-label="Angle of the first rod, degrees" aria-valuemin="-180" aria-valuemax="180" aria-valuenow="120"/>
<circle class="bob second" r=".11" tabindex="0" role="slider"
 aria-label="Angle of the second rod, degrees" aria-valuemin="-180" aria-valuemax="180" aria-valuenow="-10"/>
</svg>
<figcaption><button type="button" id="pendulum-play">Pause</button>
<span id="pendulum-says">The run of the model below, computed by <code>maup simulate</code>.
Drag a bob.</span></figcaption>
</figure>
</section>
<script type="application/json" id="pendulum-run">${JSON.stringify(trajectory(csv))}</script>
<section>
<h2 id="text">A text, and what follows from it</h2>
<div class="two">
<div>${documents.lag(text, true)}</div>
<div class="follows">${d.equations.map(e => `<div class="formula">${katexHtml(e.latex, 'start')}</div>`).join('\n')}
<p>No velocity, no T, no V was written: they follow from the places. ${d.certificate.checks.length} independent
checks certify the result${d.conserved.includes('energy') ? ', and the energy is found to be conserved' : ''}.
Then the motion, with its certain digits:</p>
<pre class="console"><code>${escape(state)}</code></pre></div>
</div>
</section>
<section>
<h2 id="mistakes">Mistakes are told in words of physics</h2>
<p>Units are checked everywhere, and each of the <a href="diagnostics/index.html">messages</a> says where,
why, and what to write instead.</p>
<pre class="message"><code>${escape(message)}</code></pre>
</section>
<section>
<h2 id="models">Models</h2>
<p>Constraints and rolling, contacts and dry friction, rigid bodies, fields, paths of stationary action:
<a href="models/index.html">all in pictures</a>, each with its equations.</p>
<ul class="cards strip">${pictures.map(pictureCard).join('\n')}</ul>
</section>
${studio ? deriveBox(text) : ''}<section>
<h2 id="ways">Ways on</h2>
<ul class="overview">
<li><a href="manual/getting_started.html">Getting started</a> <span>from the first model to a report</span></li>
<li><a href="manual/language.html">The model language</a> <span>every statement, with examples</span></li>
<li><a href="theory/index.html">Theory</a> <span>what is derived, and how it is made sure of</span></li>
<li><a href="benchmarks.html">Benchmarks</a> <span>what was measured, beside other programs</span></li>
<li><a href="api/index.html">API</a> <span>the C++ library behind it</span></li>
</ul>
</section>
`;
  return {
    path: 'index.html',
    title: 'Maupertuis: Lagrangian mechanics from a text file',
    start: true,
    wide: true,
    contents: false,
    html,
    description: 'Models of mechanics as text; certified equations of motion; motion at machine precision.',
    scripts: studio ? ['assets/pendulum.js', 'assets/derive.js'] : ['assets/pendulum.js'],
    sections: [{title: 'Maupertuis', id: '', text: 'Lagrangian mechanics from a text file'}],
  };
}

const pictureCard = model => `<li class="card"><a href="${model.path}">
<img src="models/pictures/${model.name}.svg" alt="" loading="lazy" width="480" height="330">
<b>${escape(model.title)}</b></a></li>`;

async function mistake(program, text) {
  const {writeFileSync} = await import('node:fs'),
    {join} = await import('node:path');
  const file = join(program.folder, 'pendulum.lag');
  writeFileSync(file, text + '\n');
  const {code, out, errors} = await program.run('check', file, '--color', 'never');
  const message = (errors + out)
    .replaceAll(program.folder + '/', '')
    .split(/\n(?=-- )/)[0]
    .trim();
  if (code !== 1 || !message.startsWith('-- error'))
    throw new Error('the wrong model of the start page is not refused');
  return message;
}

const deriveBox = text => `<section>
<h2 id="derive">Derive your own</h2>
<p>Change it, or write a model of your own; it opens in the studio, in this browser, and no server sees it.</p>
<label class="unseen" for="own">Model text</label>
<textarea id="own" rows="12" spellcheck="false" autocapitalize="off" autocomplete="off">${escape(text)}</textarea>
<p class="actions"><a class="button main" id="own-open"
 href="studio:#${fragmentOf(text + '\n', 'double_pendulum')}">Derive and run</a></p>
</section>
`;
