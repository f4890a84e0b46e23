// The preview over the program itself.
"use strict";
const assert = require("node:assert");
const path = require("node:path");
const test = require("node:test");
const fs = require("node:fs");
const { look, page } = require("../src/preview");

const root = path.join(__dirname, "..", "..", "..");
const program = process.env.MAUP || path.join(root, "build", "bin", "maup");
const model = (name) => fs.readFileSync(path.join(root, "models", name), "utf8");

test("equations, certificate and drawing of a model", async () => {
  const shown = await look(program, model("double_pendulum.lag"));
  assert.equal(shown.document.system, "double_pendulum");
  assert.match(shown.mathml, /<math /);
  assert.match(shown.svg, /<svg /);
  const html = page(shown);
  assert.match(html, /Certificate: passed/);
  assert.match(html, /data:image\/svg\+xml;base64,/);
  assert.doesNotMatch(html, /<script|undefined/);
});

test("a field: equations, every check of the certificate in words, the film", async () => {
  const shown = await look(program, model("fields/membrane.lag"));
  assert.match(shown.svg, /<animate /);
  const html = page(shown);
  assert.match(html, /<li>The equations shown are the computed ones/);
  assert.doesNotMatch(html, /undefined|null/);
});

test("a model with a mistake shows the mistake, and no equations", async () => {
  const shown = await look(program, "coord x : length\nT = 1/2 mm x'^2\n");
  assert.equal(shown.mathml, null);
  const html = page(shown);
  assert.match(html, /E0\d\d\d/);
  assert.match(html, /line 2/);
});

test("a model of energies alone has equations and no drawing", async () => {
  const shown = await look(
    program,
    "param m = 1 kg, k = 2 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\nrun 1 s\n",
  );
  assert.match(shown.mathml, /<math /);
  assert.equal(shown.svg, null);
});

test("what a text names is escaped", () => {
  const html = page({
    document: {
      system: "<b>&",
      diagnostics: [{ severity: '"><x', code: "E1", line: 1, message: "<i>", reason: "", help: "" }],
    },
  });
  assert.doesNotMatch(html, /<b>&|<x|<i>/);
});

test("a program that is not there, and a text that is no longer wanted", async () => {
  await assert.rejects(look("/no/such/maup", ""));
  const abort = new AbortController();
  abort.abort();
  const shown = await look(program, model("pendulum.lag"), { signal: abort.signal });
  assert.equal(shown.svg, null);
});
