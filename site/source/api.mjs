// The public headers, a page each: Doxygen reads them (XML), the pages are made here.
import {spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {escape} from './highlight.mjs';
import {all, one, parseXml, textOf} from './xml.mjs';

// Documents that comments name are pages of the site.
const documentLinks = html =>
  html.replace(/docs\/(design|theory|manual)\/(\w+)\.md/g, (all, folder, name) => {
    const area = folder === 'design' ? 'inside' : folder;
    return `<a href="../${area}/${name}.html">${name.replaceAll('_', ' ')}</a>`;
  });

export function readHeaders(root, folder) {
  mkdirSync(folder, {recursive: true});
  const headers = join(root, 'include/maupertuis');
  const settings =
    readFileSync(join(root, 'site/Doxyfile'), 'utf8') +
    `\nINPUT = "${headers}"\nOUTPUT_DIRECTORY = "${folder}"\nSTRIP_FROM_PATH = "${join(root, 'include')}"\n`;
  const {status, error, stderr} = spawnSync('doxygen', ['-'], {input: settings, encoding: 'utf8'});
  if (error?.code === 'ENOENT')
    throw new Error('doxygen is needed for the API reference; on Debian: apt install doxygen');
  if (status !== 0) throw new Error(`doxygen failed: ${stderr}`);
  const xml = join(folder, 'xml');
  return readdirSync(xml)
    .filter(name => name.endsWith('.xml') && !/^(index|Doxyfile|dir_)/.test(name))
    .map(name => one(parseXml(readFileSync(join(xml, name), 'utf8')), 'compounddef'));
}

// ------------------------------------------------------------------------------------------- descriptions and types

class Writer {
  constructor(places) {
    this.places = places;
  }

  // Text with references to other entities as links.
  inline(element) {
    return element.children
      .map(child => {
        if (typeof child === 'string') return escape(child).replace(/`([^`]+)`/g, '<code>$1</code>');
        if (child.name === 'ref') return this.reference(child);
        if (child.name === 'computeroutput') return `<code>${this.inline(child)}</code>`;
        if (child.name === 'emphasis' || child.name === 'bold') return `<em>${this.inline(child)}</em>`;
        if (child.name === 'sp') return ' ';
        return this.inline(child);
      })
      .join('');
  }

  reference(element) {
    const place = this.places.get(element.attributes.refid),
      text = escape(textOf(element));
    return place ? `<a href="${place}">${text}</a>` : text;
  }

  description(...elements) {
    return elements
      .filter(Boolean)
      .flatMap(element => element.children.filter(child => child.name === 'para'))
      .map(para => this.paragraph(para))
      .join('');
  }

  paragraph(para) {
    const blocks = {itemizedlist: 'ul', orderedlist: 'ol'};
    let html = '',
      text = {children: []};
    const flush = () => {
      const inner = documentLinks(this.inline(text).trim());
      if (inner) html += `<p>${inner}</p>\n`;
      text = {children: []};
    };
    for (const child of para.children) {
      if (child.name in blocks) {
        flush();
        html += `<${blocks[child.name]}>${all(child, 'listitem')
          .map(item => `<li>${this.description(item)}</li>`)
          .join('')}</${blocks[child.name]}>\n`;
      } else if (child.name === 'verbatim' || child.name === 'programlisting' || child.name === 'preformatted') {
        flush();
        html += `<pre><code>${escape(textOf(child))}</code></pre>\n`;
      } else if (child.name === 'simplesect') {
        flush();
        html += this.description(child);
      } else text.children.push(child);
    }
    flush();
    return html;
  }
}

const tidy = type =>
  type
    .replace(/&lt; /g, '&lt;')
    .replace(/ &gt;/g, '&gt;')
    .replace(/ (&amp;|\*)/g, '$1')
    .replace(/ \)/g, ')');

// -------------------------------------------------------------------------------------------------------- members

const shortName = name => name.replace(/^maupertuis::/, '');

function signature(member, writer) {
  const {kind} = member.attributes,
    name = `<b>${escape(textOf(one(member, 'name')))}</b>`,
    type = tidy(writer.inline(one(member, 'type') ?? {children: []})).trim();
  if (kind === 'define') return `#define ${name}`;
  if (kind === 'typedef') return `using ${name} = ${type}`;
  if (kind === 'enum') return `enum ${member.attributes.strong === 'yes' ? 'class ' : ''}${name}`;
  if (kind === 'variable') {
    const value = textOf(one(member, 'initializer')).trim();
    const shown = /^[={]/.test(value) ? value : `= ${value}`;
    return `${type ? type + ' ' : ''}${name}${value ? ` <span class="muted">${escape(shown)}</span>` : ''}`;
  }
  const parameters = all(member, 'param').map(parameter => {
    const value = textOf(one(parameter, 'defval'));
    return (
      [tidy(writer.inline(one(parameter, 'type') ?? {children: []})), escape(textOf(one(parameter, 'declname')))]
        .filter(Boolean)
        .join(' ') + (value ? ` <span class="muted">= ${escape(value)}</span>` : '')
    );
  });
  const after = member.attributes.const === 'yes' ? ' const' : '';
  return `${type ? type + ' ' : ''}${name}(${parameters.join(', ')})${after}`;
}

function memberHtml(member, writer, id) {
  const about = writer.description(one(member, 'briefdescription'), one(member, 'detaileddescription'));
  const values = all(member, 'enumvalue').map(value => {
    const says = writer.description(one(value, 'briefdescription'), one(value, 'detaileddescription'));
    return `<dt><code>${escape(textOf(one(value, 'name')))}</code></dt><dd>${says}</dd>`;
  });
  return `<div class="member" id="${id}"><p class="signature"><code>${signature(member, writer)}</code></p>\n${about}${
    values.length ? `<dl class="values">${values.join('\n')}</dl>` : ''
  }</div>\n`;
}

// ----------------------------------------------------------------------------------------------------------- pages

// What is declared together with a comment before `namespace maupertuis` speaks of the header as a whole.
function leadOf(source) {
  const block = source.match(/((?:^\/\/\/.*\n)+)namespace maupertuis/m)?.[1];
  if (!block) return '';
  const lines = block.split('\n').map(line => line.replace(/^\/\/\/ ?/, ''));
  let html = '',
    text = [],
    code = [];
  const flush = () => {
    if (text.length) html += `<p>${documentLinks(escape(text.join(' ')))}</p>\n`;
    if (code.length) html += `<pre><code>${escape(code.join('\n').trimEnd())}</code></pre>\n`;
    ((text = []), (code = []));
  };
  for (const line of lines) {
    if (line.startsWith('    ')) {
      if (text.length) flush();
      code.push(line.slice(4));
    } else if (line.trim() === '') {
      if (code.length) code.push('');
      else flush();
    } else {
      if (code.length) flush();
      text.push(line);
    }
  }
  flush();
  return html;
}

export class ApiPages {
  constructor(root, compounds) {
    this.root = root;
    this.files = new Map(); // header → [what it declares, in the order of lines]
    this.places = new Map(); // id of Doxygen → address
    for (const compound of compounds) this.collect(compound);
    this.table = this.moduleTable();
  }

  collect(compound) {
    const {kind, id} = compound.attributes,
      name = textOf(one(compound, 'compoundname'));
    if (/^(std|detail)/.test(name) || name.includes('::detail')) return;
    if (kind === 'namespace') {
      for (const section of all(compound, 'sectiondef'))
        for (const member of all(section, 'memberdef'))
          this.declare(member, shortName(`${name}::${textOf(one(member, 'name'))}`), member);
    } else if (kind === 'struct' || kind === 'class' || kind === 'union')
      this.declare(compound, shortName(name), compound);
  }

  declare(element, name, source) {
    const location = one(source, 'location');
    const header = (location.attributes.declfile ?? location.attributes.file).replace(/^.*maupertuis\//, '');
    if (!/^[\w/]+\.hpp$/.test(header)) return;
    const page = `${header.replace(/\.hpp$/, '').replaceAll('/', '-')}.html`;
    const list = this.files.get(header) ?? this.files.set(header, []).get(header);
    let anchor = name.replace(/[^\w]+/g, '-').replace(/-$/, ''),
      n = 2;
    while (list.some(entry => entry.anchor === anchor)) anchor = `${name.replace(/[^\w]+/g, '-')}-${n++}`;
    list.push({element, name, anchor, line: Number(location.attributes.line)});
    this.places.set(element.attributes.id, `${page}#${anchor}`);
  }

  // The modules and their headers are those of the table in ARCHITECTURE.md.
  moduleTable() {
    const text = readFileSync(join(this.root, 'ARCHITECTURE.md'), 'utf8');
    return [...text.matchAll(/^\| `([\w/]+)` \|[^|]*\| ([^|]*)\|$/gm)]
      .map(([, module, headers]) => [module, headers.trim().split(/\s+/).filter(Boolean)])
      .filter(([, headers]) => headers.length);
  }

  pages() {
    const writer = new Writer(this.places),
      listed = new Set(this.table.flatMap(([, headers]) => headers));
    const others = [...this.files.keys()].filter(header => !listed.has(header)).sort();
    const groups = others.length ? [...this.table, ['others', others]] : this.table;
    const present = groups
      .map(([module, headers]) => [module, headers.filter(header => this.files.has(header))])
      .filter(([, headers]) => headers.length);
    const address = header => `api/${header.replace(/\.hpp$/, '').replaceAll('/', '-')}.html`;
    const list = {
      label: 'API',
      pages: [
        ['api/index.html', 'Overview'],
        ...present.flatMap(([module, headers]) => [[module], ...headers.map(header => [address(header), header])]),
      ],
    };
    const pages = present
      .flatMap(([, headers]) => headers)
      .map(header => this.page(header, address(header), list, writer));
    const overview = present.map(
      ([module, headers]) =>
        `<h2 id="${module.replace('/', '-')}">${module}</h2>\n<ul class="overview">${headers
          .map(
            header =>
              `<li><a href="${address(header).slice(4)}">${header}</a> <span>${this.files
                .get(header)
                .slice(0, 6)
                .map(entry => escape(entry.name))
                .join(', ')}${this.files.get(header).length > 6 ? ', …' : ''}</span></li>`,
          )
          .join('\n')}</ul>\n`,
    );
    pages.unshift({
      path: 'api/index.html',
      title: 'The library',
      list: {...list, neighbours: false},
      contents: false,
      formulas: false,
      html: `<p class="lead">The headers of <code>include/maupertuis/</code>, in the order of the stages from
text to motion. <a href="../manual/library.html">The library</a> has examples,
<a href="../inside/architecture.html">Architecture</a> the data flow.</p>
${overview.join('')}`,
    });
    return pages;
  }

  page(header, path, list, writer) {
    const entries = this.files.get(header).sort((a, b) => a.line - b.line);
    const headings = entries.map(entry => ({level: 2, text: entry.name, id: entry.anchor}));
    const html = entries
      .map(
        entry =>
          `<section class="entry">
<h2 id="${entry.anchor}">${escape(entry.name)}</h2>
${this.entryHtml(entry, writer)}</section>\n`,
      )
      .join('');
    const lead = leadOf(readFileSync(join(this.root, 'include/maupertuis', header), 'utf8'));
    const sections = entries.map(entry => ({
      title: entry.name,
      id: entry.anchor,
      text: textOf(one(entry.element, 'briefdescription')) + ' ' + textOf(one(entry.element, 'detaileddescription')),
    }));
    return {
      path,
      title: header,
      titleHtml: `<code>${header}</code>`,
      html: `<pre class="include"><code>#include &lt;maupertuis/${header}&gt;</code></pre>\n${lead}${html}`,
      headings,
      list,
      formulas: false,
      sections,
    };
  }

  entryHtml({element, anchor}, writer) {
    if (element.name === 'memberdef') return memberHtml(element, writer, `${anchor}-declaration`);
    const about = writer.description(one(element, 'briefdescription'), one(element, 'detaileddescription'));
    const bases = all(element, 'basecompoundref').map(base => writer.reference(base));
    const members = all(element, 'sectiondef')
      .filter(section => /^public|^user-defined/.test(section.attributes.kind))
      .flatMap(section => all(section, 'memberdef'))
      .filter(member => member.attributes.kind !== 'friend')
      .sort((a, b) => Number(one(a, 'location').attributes.line) - Number(one(b, 'location').attributes.line));
    const base = bases.length ? `<p class="muted">is a ${bases.join(', ')}</p>\n` : '';
    return base + about + members.map((member, i) => memberHtml(member, writer, `${anchor}-${i + 1}`)).join('');
  }
}
