// `maup lsp` as a test asks it: one request after the other.
"use strict";
const { spawn } = require("node:child_process");

class LanguageServer {
  constructor(program) {
    this.child = spawn(program, ["lsp", "--stdio"]);
    this.waiting = new Map();
    this.last = 0;
    let bytes = Buffer.alloc(0);
    this.child.stdout.on("data", (more) => {
      bytes = Buffer.concat([bytes, more]);
      for (;;) {
        const head = bytes.indexOf("\r\n\r\n");
        if (head < 0) return;
        const begin = head + 4;
        const end = begin + Number(/Content-Length: (\d+)/i.exec(bytes.toString("latin1", 0, head))[1]);
        if (bytes.length < end) return;
        const message = JSON.parse(bytes.toString("utf8", begin, end));
        bytes = bytes.subarray(end);
        if (this.waiting.has(message.id)) this.waiting.get(message.id)(message.result);
      }
    });
  }

  send(message) {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    this.child.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }

  ask(method, params) {
    const id = ++this.last;
    return new Promise((answered) => {
      this.waiting.set(id, answered);
      this.send({ id, method, params });
    });
  }

  async start() {
    const { capabilities } = await this.ask("initialize", {
      processId: null,
      rootUri: null,
      capabilities: {},
      initializationOptions: { derivation: false },
    });
    this.kinds = capabilities.semanticTokensProvider.legend.tokenTypes;
    this.send({ method: "initialized", params: {} });
  }

  /// The tokens of a text: [{line, from, to, kind}], kinds as the protocol names them.
  async tokens(text) {
    const uri = "file:///model.lag";
    const textDocument = { uri, languageId: "lag", version: 1, text };
    this.send({ method: "textDocument/didOpen", params: { textDocument } });
    const { data } = await this.ask("textDocument/semanticTokens/full", { textDocument: { uri } });
    this.send({ method: "textDocument/didClose", params: { textDocument: { uri } } });
    const out = [];
    let line = 0;
    let from = 0;
    for (let i = 0; i < data.length; i += 5) {
      from = data[i] === 0 ? from + data[i + 1] : data[i + 1];
      line += data[i];
      out.push({ line, from, to: from + data[i + 2], kind: this.kinds[data[i + 3]] });
    }
    return out;
  }

  async end() {
    await this.ask("shutdown");
    this.send({ method: "exit" });
  }
}

module.exports = { LanguageServer };
