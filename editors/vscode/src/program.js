// Runs maup on the text of an editor.
"use strict";
const { spawn } = require("node:child_process");

/// {code, out, err}; rejects where the program cannot be started. `signal` (an AbortSignal) and `limit` (milliseconds)
/// end it.
function run(program, args, input, { signal, limit = 30000, cwd } = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(program, args, { cwd, windowsHide: true });
    const end = () => child.kill("SIGTERM");
    const timer = setTimeout(end, limit);
    if (signal) signal.addEventListener("abort", end, { once: true });
    const parts = { out: [], err: [] };
    child.stdout.on("data", (bytes) => parts.out.push(bytes));
    child.stderr.on("data", (bytes) => parts.err.push(bytes));
    child.on("error", (error) => {
      clearTimeout(timer);
      reject(error);
    });
    child.on("close", (code) => {
      clearTimeout(timer);
      resolve({
        code,
        out: Buffer.concat(parts.out).toString("utf8"),
        err: Buffer.concat(parts.err).toString("utf8"),
      });
    });
    child.stdin.on("error", () => {});
    child.stdin.end(input);
  });
}

module.exports = { run };
