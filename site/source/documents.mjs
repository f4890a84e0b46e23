// Manual, theory and what is inside: the pages of docs/ in the order in which one reads them.
import {existsSync, readFileSync, readdirSync, statSync} from 'node:fs';
import {basename, dirname, join, normalize} from 'node:path';
import {relative} from './layout.mjs';
import {escape} from './highlight.mjs';

// A page of these folders that is not listed is an error: nothing stands in the repository and is missing here.
const manual = [
  'getting_started',
  'language',
  'command_line',
  'pictures',
  'modes',
  'diagnostics',
  'studio',
  'editors',
  'library',
];
const theory = {
  Foundations: ['conventions', 'euler_lagrange', 'certificate', 'readable_form', 'zero_test'],
  Systems: ['constraints', 'rates', 'contacts', 'switches', 'degenerate', 'fields'],
  'Phase space and symmetry': ['hamiltonian', 'invariants', 'two_descriptions'],
  Motion: ['taylor', 'variational', 'stiff', 'tangent'],
  Study: ['linearization', 'orbits', 'action', 'measures'],
};
const inside = {
  'The project': ['ARCHITECTURE.md', 'CONTRIBUTING.md', 'CHANGELOG.md', 'docs/reference_cases.md', 'site/README.md'],
};
const insideNames = {
  'site/README.md': 'site',
  'ARCHITECTURE.md': 'architecture',
  'CONTRIBUTING.md': 'contributing',
  'CHANGELOG.md': 'changes',
  'docs/reference_cases.md': 'reference_cases',
};

export class DocumentPages {
  constructor(root) {
    this.root = root;
    this.addresses = new Map(); // file of the repository → page of the site
    this.entries = [];
    const known = folder =>
      readdirSync(join(root, folder))
        .filter(name => name.endsWith('.md'))
        .map(name => `${folder}/${name}`);
    for (const name of manual) this.add(`docs/manual/${name}.md`, `manual/${name}.html`, 'manual');
    for (const [group, names] of Object.entries(theory))
      for (const name of names) this.add(`docs/theory/${name}.md`, `theory/${name}.html`, 'theory', group);
    for (const file of inside['The project'])
      this.add(file, `inside/${insideNames[file]}.html`, 'inside', 'The project');
    for (const file of known('docs/design'))
      this.add(file, `inside/${basename(file, '.md')}.html`, 'inside', 'Design');
    const others = ['manual', 'theory']
      .flatMap(folder => known(`docs/${folder}`))
      .filter(file => !this.addresses.has(file));
    for (const file of others)
      this.add(
        file,
        file.replace('docs/', '').replace('.md', '.html'),
        file.split('/')[1],
        file.includes('theory') ? 'More' : undefined,
      );
    for (const name of readdirSync(join(root, 'docs/pictures')))
      this.addresses.set(`docs/pictures/${name}`, `pictures/${name}`); // drawn anew
    this.addresses.set('docs/benchmarks.md', 'benchmarks.html');
    this.addresses.set('docs/gallery/README.md', 'models/index.html');
    this.addresses.set('models/README.md', 'models/index.html');
    this.addresses.set('models', 'models/index.html');
    this.addresses.set('tests/problems', 'inside/reference_cases.html');
    this.addresses.set('docs/manual/grammar.ebnf', 'manual/grammar.html');
    this.addresses.set('README.md', 'index.html');
    this.addresses.set('docs/manual', 'manual/index.html');
    this.addresses.set('docs/theory', 'theory/index.html');
    this.addresses.set('docs/design', 'inside/index.html');
  }

  add(file, path, area, group) {
    if (!existsSync(join(this.root, file)))
      throw new Error(`${file} is listed in site/source/documents.mjs and does not exist`);
    this.addresses.set(file, path);
    this.entries.push({
      file,
      path,
      area,
      group,
      title: readFileSync(join(this.root, file), 'utf8').match(/^# (.*)/m)[1],
    });
  }

  // The address of a link in `env.file`, seen from its page; null for a file of the repository that is no page here.
  linkOf(target, env) {
    if (target.startsWith('#')) return target;
    if (/^[a-z]+:/i.test(target)) return target;
    const [path, anchor] = target.split('#'),
      file = normalize(join(dirname(env.file), decodeURI(path))).replace(/\/$/, '');
    const page = this.addresses.get(file);
    if (!page && existsSync(join(this.root, file))) return null;
    if (!page) throw new Error(`${env.file}: the link to ${target} leads nowhere`);
    return relative(this.addresses.get(env.file) ?? env.path, page + (anchor ? `#${anchor}` : ''));
  }

  // What a link is called whose text is the name of the file.
  titleOf(target, env) {
    const file = normalize(join(dirname(env.file), target.split('#')[0]));
    return this.entries.find(entry => entry.file === file)?.title;
  }

  pages(documents) {
    for (const entry of this.entries)
      Object.assign(entry, documents.render(readFileSync(join(this.root, entry.file), 'utf8'), entry.file));
    return this.entries.map(entry => ({...entry, list: this.listOf(entry.area), area: `${entry.area}/index.html`}));
  }

  listOf(area) {
    const names = {manual: 'Manual', theory: 'Theory', inside: 'Inside'},
      pages = [[`${area}/index.html`, 'Overview']];
    let group;
    for (const entry of this.entries.filter(entry => entry.area === area)) {
      if (entry.group && entry.group !== group) pages.push([(group = entry.group)]);
      pages.push([entry.path, entry.title]);
      if (entry.path === 'manual/language.html') pages.push(['manual/grammar.html', 'Grammar']);
    }
    return {label: names[area], pages};
  }

  overview(area, title, lead) {
    const path = `${area}/index.html`;
    let html = `<p class="lead">${lead}</p>\n`,
      group,
      open = false;
    for (const entry of this.entries.filter(entry => entry.area === area)) {
      if (entry.group !== group || !open) {
        html +=
          (open ? '</ul>\n' : '') +
          (entry.group ? `<h2 id="${entry.group.toLowerCase().replace(/\W+/g, '-')}">${entry.group}</h2>\n` : '') +
          '<ul class="overview">\n';
        ((group = entry.group), (open = true));
      }
      html += `<li><a href="${relative(path, entry.path)}">${escape(entry.title)}</a>
<span>${escape(firstSentence(entry))}</span></li>\n`;
    }
    return {path, title, html: html + '</ul>\n', list: {...this.listOf(area), neighbours: false}, contents: false};
  }
}

// Of the first paragraph; a sentence that only leads to a list or a formula says little, and is cut at its colon.
function firstSentence({sections}) {
  const text = (sections.find(section => section.prose.trim() !== '')?.prose ?? '').trim();
  const end = text.search(/(?<=[\p{L}\p{N})`"])[.:](\s|$)/u);
  const sentence = end < 0 ? text : text.slice(0, end + 1);
  const short = sentence.length > 180 ? sentence.slice(0, sentence.lastIndexOf(' ', 170)) + ' …' : sentence;
  return short.replace(/:$/, '.');
}
