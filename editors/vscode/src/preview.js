// The page beside the text: equations, certificate, the drawing in motion. No script runs in it.
"use strict";
const fs = require("node:fs/promises");
const os = require("node:os");
const path = require("node:path");
const { run } = require("./program");

const escaped = (text) =>
  String(text).replace(
    /[&<>"']/g,
    (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" })[c],
  );

/// A sentence of a message; what stands between ticks is text of a model.
const sentence = (text) => escaped(text || "").replace(/`([^`]*)`/g, "<code>$1</code>");

/// What there is to show of a text: {document, mathml, svg, messages}. Each part is null where it could not be made.
async function look(program, text, options = {}) {
  const json = await run(program, ["derive", "-", "--json"], text, options);
  const shown = { document: null, mathml: null, svg: null, messages: json.err };
  try {
    shown.document = JSON.parse(json.out);
  } catch {
    return shown;
  }
  if (json.code !== 0 || (options.signal && options.signal.aborted)) return shown;
  const [formulas, svg] = await Promise.all([
    run(program, ["derive", "-", "--mathml"], text, options),
    drawing(program, text, options),
  ]);
  if (formulas.code === 0) shown.mathml = formulas.out;
  shown.svg = svg;
  return shown;
}

/// The animated SVG of the drawing; null for a model that draws nothing or has no run.
async function drawing(program, text, options) {
  const folder = await fs.mkdtemp(path.join(os.tmpdir(), "maupertuis-"));
  try {
    const file = path.join(folder, "drawing.svg");
    const made = await run(program, ["animate", "-", "-o", file, "--size", "480"], text, options);
    return made.code === 0 ? await fs.readFile(file, "utf8") : null;
  } finally {
    await fs.rm(folder, { recursive: true, force: true });
  }
}

function messages(document) {
  const items = (document && document.diagnostics) || [];
  const rows = items.map(
    (d) =>
      `<li class="${escaped(d.severity)}"><b>${escaped(d.code)}</b> ${d.line ? `line ${escaped(d.line)}: ` : ""}` +
      `${sentence(d.message)} <span>${sentence(d.reason)} ${sentence(d.help)}</span></li>`,
  );
  return rows.length ? `<ul>${rows.join("")}</ul>` : "";
}

function certificate(document) {
  const found = document && document.certificate;
  if (!found) return "";
  const rows = found.checks.map((c) => `<li>${escaped(c.statement)} <span>(${escaped(c.points)} points)</span></li>`);
  return `<h2>Certificate: ${found.passed ? "passed" : "not passed"}</h2><ul class="certificate">${rows.join("")}</ul>`;
}

const style = `
body { font: var(--vscode-font-size, 13px)/1.5 var(--vscode-font-family, sans-serif); padding: 0 1.2em 2em;
  max-width: 60em; }
h1 { font-size: 1.3em; font-weight: 600; margin: 1em 0 0.6em; }
h2 { font-size: 1em; font-weight: 600; margin: 1.6em 0 0.4em; }
img { width: 100%; max-width: 480px; background: #fff; border-radius: 4px; }
/* Drawings have the colours of white paper; in a dark editor their lightness is turned round. */
.vscode-dark img, .vscode-high-contrast:not(.vscode-high-contrast-light) img { filter: invert(0.9) hue-rotate(180deg); }
.equations { overflow-x: auto; padding: 0.4em 0; }
math { font-size: 1.25em; }
mtd { padding: 0.35em 0; text-align: left; }
ul { padding-left: 1.2em; margin: 0.4em 0; }
li span { opacity: 0.7; }
.error b { color: var(--vscode-editorError-foreground, #c00); }
.warning b { color: var(--vscode-editorWarning-foreground, #a60); }
pre { white-space: pre-wrap; }
code { font-family: var(--vscode-editor-font-family, monospace); }`;

/// The page of what `look` found.
function page(shown) {
  const document = shown.document;
  const title = document && document.system ? document.system : "Model";
  const parts = [`<h1>${escaped(title)}</h1>`];
  if (shown.svg)
    parts.push(
      `<img alt="The drawing in motion" src="data:image/svg+xml;base64,${Buffer.from(shown.svg).toString("base64")}">`,
    );
  if (shown.mathml) parts.push(`<h2>Equations of motion</h2><div class="equations">${shown.mathml}</div>`);
  parts.push(messages(document));
  if (!document && shown.messages) parts.push(`<pre>${escaped(shown.messages)}</pre>`);
  parts.push(certificate(document));
  const policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
  return (
    `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">` +
    `<meta http-equiv="Content-Security-Policy" content="${policy}">` +
    `<title>${escaped(title)}</title><style>${style}</style></head><body>${parts.join("\n")}</body></html>`
  );
}

module.exports = { look, page };
