// A worker that holds the core: {id, request} comes, {id, message} … and {id, answer} go, all JSON texts but for `id`.
//
// It is the text of maup.js and of this file one after the other (maup_worker.js). The first message may be
//   {start: {wasm, cancel}}   wasm: bytes of maup.wasm, or a WebAssembly.Module of an earlier worker; without it the
//                             file beside this script is fetched. cancel: an Int32Array over a SharedArrayBuffer
// and is answered by {started: WebAssembly.Module}, for the next worker. What cannot go on says {failed: "why"}: a
// worker that failed is to be ended.
//
// How a request is cancelled: a worker does not hear while it computes. Where pages may share memory, `cancel[0] = id`
// ends the request of this number within a step of its work, with what it knew kept. Elsewhere (file://, hosts without
// the headers of cross-origin isolation) the page ends the worker, starts another with the Module, and opens the text
// again. Without either a request ends with its budget.
'use strict';

const needed = {
  // A function that makes a vector; a function with try and catch.
  'WebAssembly SIMD': [
    0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
  ],
  'WebAssembly exceptions': [
    0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 8, 1, 6, 0, 6, 64, 25, 11, 11,
  ],
};

function missing() {
  if (typeof WebAssembly !== 'object') return 'WebAssembly';
  return Object.keys(needed).find(name => !WebAssembly.validate(new Uint8Array(needed[name])));
}

class Core {
  constructor(module, cancel) {
    this.module = module;
    this.studio = module._maup_create(cancel ? 1 : 0);
  }

  answer(request) {
    const text = typeof request === 'string' ? request : JSON.stringify(request);
    const bytes = this.module.lengthBytesUTF8(text) + 1;
    const place = this.module._malloc(bytes);
    if (!place) throw new Error('the memory is not enough');
    try {
      this.module.stringToUTF8(text, place, bytes);
      return this.module.UTF8ToString(this.module._maup_answer(this.studio, place));
    } finally {
      this.module._free(place);
    }
  }
}

let starting = null,
  current = 0;

/** The module compiled, at most once. */
async function compiled(wasm) {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (wasm) return WebAssembly.compile(wasm);
  const response = await fetch(new URL('maup.wasm', self.location.href));
  if (!response.ok) throw new Error(`maup.wasm cannot be read: ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

async function start({wasm, cancel}) {
  const lack = missing();
  if (lack) throw new Error(`this browser has no ${lack}`);
  const code = await compiled(wasm);
  const module = await maupertuis({
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(code, imports).then(instance => done(instance, code));
      return {};
    },
    message: text => self.postMessage({id: current, message: text}),
    cancelled: () => Atomics.load(cancel, 0) === current,
  });
  self.postMessage({started: code});
  return new Core(module, cancel);
}

self.onmessage = async ({data}) => {
  try {
    starting = starting || start(data.start || {});
    const core = await starting;
    if (data.request === undefined) return;
    current = data.id;
    self.postMessage({id: data.id, answer: core.answer(data.request)});
  } catch (error) {
    self.postMessage({failed: String((error && error.message) || error)});
  }
};
