// The grammar as Visual Studio Code reads it.
"use strict";
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const oniguruma = require("vscode-oniguruma");
const { Registry, INITIAL, parseRawGrammar } = require("vscode-textmate");

const file = path.join(__dirname, "..", "syntaxes", "lag.tmLanguage.json");

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

test("every line of the gallery is read to its end", async () => {
  const rules = await grammar();
  const folder = path.join(__dirname, "..", "..", "..", "models");
  for (const name of fs.readdirSync(folder).filter((n) => n.endsWith(".lag")))
    for (const line of fs.readFileSync(path.join(folder, name), "utf8").split("\n")) {
      const { tokens, stoppedEarly } = rules.tokenizeLine(line, INITIAL);
      assert.ok(!stoppedEarly && tokens[tokens.length - 1].endIndex >= line.length);
    }
});
