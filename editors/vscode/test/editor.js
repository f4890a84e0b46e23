// As much of the interface of Visual Studio Code as the extension uses, for tests: `require` finds it under the names
// `vscode` and `vscode-languageclient/node`. What the extension does is kept in lists.
"use strict";
const Module = require("node:module");

class Emitter {
  listeners = new Set();
  on = (listener) => {
    this.listeners.add(listener);
    return { dispose: () => this.listeners.delete(listener) };
  };
  fire(event) {
    return Promise.all([...this.listeners].map((listener) => listener(event)));
  }
}

/// A text that is open; `change` is what a user types.
class TextDocument {
  constructor(fileName, text, languageId = "lag") {
    Object.assign(this, { fileName, text, languageId, isUntitled: false, saves: 0, mayBeSaved: true });
    this.uri = { toString: () => `file://${fileName}` };
  }
  getText() {
    return this.text;
  }
  async save() {
    ++this.saves;
    return this.mayBeSaved;
  }
}

function editor() {
  const changed = new Emitter();
  const configured = new Emitter();
  const it = { commands: {}, executed: [], panels: [], terminals: [], errors: [], clients: [], settings: {},
    answer: undefined };
  const vscode = {
    ViewColumn: { Beside: -2 },
    workspace: {
      getConfiguration: (section) => ({ get: (name) => it.settings[`${section}.${name}`] }),
      onDidChangeTextDocument: changed.on,
      onDidChangeConfiguration: configured.on,
    },
    window: {
      activeTextEditor: undefined,
      createOutputChannel: () => ({ dispose() {} }),
      createTerminal: (options) => {
        const terminal = { options, show() {} };
        it.terminals.push(terminal);
        return terminal;
      },
      showErrorMessage: async (text) => {
        it.errors.push(text);
        return it.answer;
      },
      createWebviewPanel: (kind, title, where, options) => {
        const disposed = new Emitter();
        const panel = {
          title,
          options,
          pages: [],
          onDidDispose: disposed.on,
          close: () => disposed.fire(),
          reveal: () => ++panel.revealed,
          revealed: 0,
          webview: {
            set html(page) {
              panel.pages.push(page);
            },
          },
        };
        it.panels.push(panel);
        return panel;
      },
    },
    commands: {
      registerCommand: (name, command) => {
        it.commands[name] = command;
        return { dispose: () => delete it.commands[name] };
      },
      executeCommand: (...words) => it.executed.push(words),
    },
  };
  class LanguageClient {
    constructor(id, name, server, options) {
      Object.assign(this, { server, options, running: false });
      it.clients.push(this);
    }
    async start() {
      if (it.refusal) throw it.refusal;
      this.running = true;
    }
    async stop() {
      if (!this.running) throw new Error("it does not run");
      this.running = false;
    }
  }
  Object.assign(it, {
    open: (document) => (vscode.window.activeTextEditor = document && { document }),
    type: (document, text) => {
      document.text = text;
      return changed.fire({ document });
    },
    watchers: () => changed.listeners.size,
    set: (name, value) => {
      it.settings[name] = value;
      return configured.fire({ affectsConfiguration: (section) => name.startsWith(`${section}.`) });
    },
  });
  const load = Module._load;
  Module._load = function (name, ...rest) {
    if (name === "vscode") return vscode;
    if (name === "vscode-languageclient/node") return { LanguageClient };
    return load.call(this, name, ...rest);
  };
  const file = require.resolve("../src/extension");
  delete require.cache[file];
  it.extension = require(file);
  Module._load = load;
  return it;
}

module.exports = { editor, TextDocument };
