// The client of `maup lsp`, and the commands.
"use strict";
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { look, page } = require("./preview");

let client;

const settings = () => vscode.workspace.getConfiguration("maupertuis");
const program = () => settings().get("program") || "maup";

async function start(output) {
  const command = program();
  client = new LanguageClient(
    "maupertuis",
    "Maupertuis",
    { command, args: ["lsp", "--stdio"] },
    {
      documentSelector: [{ language: "lag" }],
      outputChannel: output,
      initializationOptions: {
        derivation: settings().get("derivation"),
        derivationBudget: settings().get("derivationBudget"),
      },
    },
  );
  try {
    await client.start();
  } catch (error) {
    const answer = await vscode.window.showErrorMessage(
      `maup could not be started (${command}): ${error.message || error}. Install it, or name it in the settings.`,
      "Open Settings",
    );
    if (answer) vscode.commands.executeCommand("workbench.action.openSettings", "maupertuis.program");
  }
}

async function stop() {
  const old = client;
  client = undefined;
  if (old) await old.stop().catch(() => {});
}

/// The page of one text; it follows the text until it is closed.
class Preview {
  static open = new Map(); // by the address of the text

  constructor(document) {
    this.uri = document.uri.toString();
    Preview.open.set(this.uri, this);
    this.panel = vscode.window.createWebviewPanel(
      "maupertuis.preview",
      `Preview: ${document.fileName.split(/[\\/]/).pop()}`,
      {
        viewColumn: vscode.ViewColumn.Beside,
        preserveFocus: true,
      },
    );
    const changes = vscode.workspace.onDidChangeTextDocument((event) => {
      if (event.document.uri.toString() === this.uri) this.later(event.document);
    });
    this.panel.onDidDispose(() => {
      Preview.open.delete(this.uri);
      changes.dispose();
      clearTimeout(this.timer);
      if (this.abort) this.abort.abort();
    });
    this.show(document);
  }

  later(document) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.show(document), 400);
  }

  async show(document) {
    if (this.abort) this.abort.abort();
    const abort = (this.abort = new AbortController());
    try {
      const shown = await look(program(), document.getText(), { signal: abort.signal });
      if (!abort.signal.aborted) this.panel.webview.html = page(shown);
    } catch (error) {
      if (!abort.signal.aborted) this.panel.webview.html = page({ messages: `${program()}: ${error.message}` });
    }
  }
}

function preview() {
  const editor = vscode.window.activeTextEditor;
  if (!editor || editor.document.languageId !== "lag") return;
  const shown = Preview.open.get(editor.document.uri.toString());
  if (shown) shown.panel.reveal(vscode.ViewColumn.Beside, true);
  else new Preview(editor.document);
}

async function test() {
  const editor = vscode.window.activeTextEditor;
  if (!editor || editor.document.languageId !== "lag") return;
  if (editor.document.isUntitled || !(await editor.document.save())) return;
  const terminal = vscode.window.createTerminal({
    name: "maup test",
    shellPath: program(),
    shellArgs: ["test", editor.document.fileName],
  });
  terminal.show(true);
}

async function activate(context) {
  const output = vscode.window.createOutputChannel("Maupertuis");
  context.subscriptions.push(
    output,
    vscode.commands.registerCommand("maupertuis.preview", preview),
    vscode.commands.registerCommand("maupertuis.test", test),
    vscode.commands.registerCommand("maupertuis.restart", async () => {
      await stop();
      await start(output);
    }),
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (!event.affectsConfiguration("maupertuis")) return;
      await stop();
      await start(output);
    }),
  );
  await start(output);
}

module.exports = { activate, deactivate: stop };
