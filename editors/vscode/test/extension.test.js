// The extension in an editor that is a stand-in, over the program itself.
"use strict";
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const { editor, TextDocument } = require("./editor");
const { contributes } = require("../package.json");

const root = path.join(__dirname, "..", "..", "..");
const program = process.env.MAUP || path.join(root, "build", "bin", "maup");
const pendulum = path.join(root, "models", "pendulum.lag");

async function started(settings = {}) {
  const it = editor();
  Object.assign(it.settings, { "maupertuis.program": program, ...settings });
  const context = { subscriptions: [] };
  await it.extension.activate(context);
  return { it, context };
}

async function until(holds, what) {
  for (let i = 0; i < 400; ++i, await new Promise((r) => setTimeout(r, 25))) if (holds()) return;
  assert.fail(`waited in vain for ${what}`);
}

const opened = () => new TextDocument(pendulum, fs.readFileSync(pendulum, "utf8"));

test("the commands are those that the manifest names", async () => {
  const { it, context } = await started();
  assert.deepEqual(Object.keys(it.commands).sort(), contributes.commands.map((c) => c.command).sort());
  for (const subscription of context.subscriptions) subscription.dispose();
  assert.deepEqual(Object.keys(it.commands), []);
});

test("the language server is started with the settings, and anew when they change", async () => {
  const { it } = await started({ "maupertuis.derivation": false, "maupertuis.derivationBudget": 500 });
  const [client] = it.clients;
  assert.ok(client.running);
  assert.deepEqual(client.server, { command: program, args: ["lsp", "--stdio"] });
  assert.deepEqual(client.options.documentSelector, [{ language: "lag" }]);
  assert.deepEqual(client.options.initializationOptions, { derivation: false, derivationBudget: 500 });
  await it.set("editor.fontSize", 20);
  assert.equal(it.clients.length, 1);
  await it.set("maupertuis.derivation", true);
  assert.deepEqual([it.clients.length, client.running, it.clients[1].running], [2, false, true]);
  assert.equal(it.clients[1].options.initializationOptions.derivation, true);
  await it.commands["maupertuis.restart"]();
  assert.deepEqual([it.clients.length, it.clients[1].running, it.clients[2].running], [3, false, true]);
  await it.extension.deactivate();
  assert.equal(it.clients[2].running, false);
});

test("a program that cannot be started is said, and can be mended in the settings", async () => {
  const it = editor();
  it.refusal = new Error("spawn maup ENOENT");
  it.answer = "Open Settings";
  await it.extension.activate({ subscriptions: [] });
  assert.equal(it.clients[0].server.command, "maup");
  assert.match(it.errors[0], /could not be started \(maup\): spawn maup ENOENT/);
  assert.deepEqual(it.executed, [["workbench.action.openSettings", "maupertuis.program"]]);
  it.refusal = undefined;
  await it.set("maupertuis.program", program);
  assert.ok(it.clients[1].running);
});

test("the preview shows equations and drawing, and follows the text until it is closed", async () => {
  const { it } = await started();
  const document = opened();
  it.open(document);
  it.commands["maupertuis.preview"]();
  const [panel] = it.panels;
  assert.equal(panel.title, "Preview: pendulum.lag");
  assert.ok(!(panel.options && panel.options.enableScripts), "no script runs in it");
  await until(() => panel.pages.length === 1, "the page");
  assert.match(panel.pages[0], /<math [\s\S]*Certificate: passed/);
  assert.match(panel.pages[0], /data:image\/svg\+xml/);
  // Two changes at once are one page, of the newer text.
  it.type(document, `${document.text}\nlet wrong = q\n`);
  it.type(document, document.text.replace("let wrong = q", "let wrong = zz"));
  await until(() => panel.pages.length === 2, "the page of the change");
  assert.match(panel.pages[1], /<code>zz<\/code>/);
  it.type(new TextDocument("/other.lag", ""), "coord x : length");
  await new Promise((r) => setTimeout(r, 500));
  assert.equal(panel.pages.length, 2, "another text is another preview's business");
  const watchers = it.watchers();
  it.type(document, opened().text);
  panel.close();
  assert.equal(it.watchers(), watchers - 1);
  await new Promise((r) => setTimeout(r, 600));
  assert.equal(panel.pages.length, 2, "nothing is written into a page that was closed");
});

test("a second call for the preview of a text shows the one that is there", async () => {
  const { it } = await started();
  it.open(opened());
  it.commands["maupertuis.preview"]();
  it.commands["maupertuis.preview"]();
  assert.deepEqual([it.panels.length, it.panels[0].revealed], [1, 1]);
  await until(() => it.panels[0].pages.length === 1, "the page");
  it.panels[0].close();
  it.commands["maupertuis.preview"]();
  assert.equal(it.panels.length, 2, "a closed one is opened anew");
  it.panels[1].close();
});

test("no preview of what is no model; a program that is missing is named on the page", async () => {
  const { it } = await started({ "maupertuis.program": "/no/such/maup" });
  it.commands["maupertuis.preview"]();
  it.open(new TextDocument("/notes.txt", "", "plaintext"));
  it.commands["maupertuis.preview"]();
  assert.equal(it.panels.length, 0);
  it.open(opened());
  it.commands["maupertuis.preview"]();
  await until(() => it.panels[0].pages.length === 1, "the page");
  assert.match(it.panels[0].pages[0], /\/no\/such\/maup: .*ENOENT/);
});

test("the expectations are run of the file that was saved", async () => {
  const { it } = await started();
  const run = it.commands["maupertuis.test"];
  await run();
  const document = opened();
  it.open(document);
  await run();
  assert.equal(document.saves, 1);
  assert.deepEqual(
    it.terminals.map((t) => [t.options.shellPath, t.options.shellArgs]),
    [[program, ["test", pendulum]]],
  );
  document.mayBeSaved = false;
  await run();
  assert.equal(it.terminals.length, 1, "what could not be saved is not run");
});
