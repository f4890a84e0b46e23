// The grammar as Visual Studio Code reads it.
"use strict";
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const oniguruma = require("vscode-oniguruma");
const { Registry, INITIAL, parseRawGrammar } = require("vscode-textmate");

const { LanguageServer } = require("./language_server");

const file = path.join(__dirname, "..", "syntaxes", "lag.tmLanguage.json");
const root = path.join(__dirname, "..", "..", "..");
const models = path.join(root, "models");
const program = process.env.MAUP || path.join(root, "build", "bin", "maup");

async function grammar() {
  const wasm = fs.readFileSync(path.join(path.dirname(require.resolve("vscode-oniguruma")), "onig.wasm"));
  await oniguruma.loadWASM({ data: wasm });
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => parseRawGrammar(fs.readFileSync(file, "utf8"), file),
  });
  return registry.loadGrammar("source.lag");
}

/// The innermost scope of each word of a line.
function scopes(rules, line) {
  const found = {};
  for (const token of rules.tokenizeLine(line, INITIAL).tokens) {
    const text = line.slice(token.startIndex, token.endIndex).trim();
    if (text) found[text] = token.scopes[token.scopes.length - 1].replace(/\.lag$/, "");
  }
  return found;
}

test("words have the scopes that themes colour", async () => {
  const rules = await grammar();
  const point = scopes(rules, "point bob mass m at l (sin θ, -cos θ1)  # falls, param");
  assert.equal(point.point, "keyword.control");
  assert.equal(point.bob, "variable.other");
  assert.equal(point.mass, "keyword.other");
  assert.equal(point.sin, "support.function");
  assert.equal(point["θ1"], "variable.other");
  assert.equal(point["# falls, param"], "comment.line.number-sign");
  const energy = scopes(rules, "T += 1/2 m θ̇² + 3 [kg m^2] x' B.ω");
  assert.equal(energy.T, "keyword.control");
  assert.equal(energy["θ̇"], "variable.other");
  assert.equal(energy.kg, "support.type.unit");
  assert.equal(energy["'"], "keyword.operator.derivative");
  assert.equal(energy["ω"], "variable.other.member");
  const text = scopes(rules, 'system a "A point, mass m"');
  assert.equal(text['"A point, mass m"'], "string.quoted.double");
  // Words of the language inside of names are none, and statement words within a line are names.
  const inside = scopes(rules, "let mass_1 = at2 + coord");
  assert.equal(inside.mass_1, "variable.other");
  assert.equal(inside.at2, "variable.other");
  assert.equal(inside.coord, "variable.other");
});

/// What the language server calls a piece of text, and what the grammar may call it before the server is there. A name
/// that is a word elsewhere (a point `left`), and a unit behind a number, are known to the server alone.
const same = {
  keyword: ["keyword.control", "keyword.other", "keyword.other.word", "support.function", "variable.other"],
  function: ["support.function"],
  parameter: ["variable.other"],
  variable: ["variable.other"],
  macro: ["variable.other", "constant.language"],
  class: ["variable.other", "keyword.other.word"],
  property: ["variable.other.member"],
  type: ["support.type.unit", "variable.other"],
  number: ["constant.numeric"],
  string: ["string.quoted.double"],
  comment: ["comment.line.number-sign"],
  operator: ["keyword.operator", "keyword.operator.derivative", "meta.unit", "source"],
};

test("the grammar says of every model what the language server says", async () => {
  const rules = await grammar();
  const server = new LanguageServer(program);
  await server.start();
  let seen = 0;
  for (const name of fs.readdirSync(models, { recursive: true }).filter((n) => n.endsWith(".lag"))) {
    const text = fs.readFileSync(path.join(models, name), "utf8");
    const lines = text.split("\n");
    const scopes = lines.map((line) => {
      const { tokens, stoppedEarly } = rules.tokenizeLine(line, INITIAL);
      assert.ok(!stoppedEarly && tokens[tokens.length - 1].endIndex >= line.length, `${name}: ${line}`);
      return tokens;
    });
    for (const { line, from, to, kind } of await server.tokens(text)) {
      const token = scopes[line].find((t) => t.startIndex <= from && from < t.endIndex);
      const scope = token.scopes[token.scopes.length - 1].replace(/\.lag$/, "");
      const what = lines[line].slice(from, to);
      assert.ok(same[kind].includes(scope), `${name}:${line + 1}: ${what} is ${kind}, and ${scope} in the grammar`);
      assert.ok(kind === "operator" || token.endIndex === to, `${name}:${line + 1}: ${what} ends elsewhere`);
      ++seen;
    }
  }
  await server.end();
  assert.ok(seen > 20000, `${seen} pieces`);
});
