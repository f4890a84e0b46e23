import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {project} from './requests.mjs';

const bin = project + 'build-wasm/bin/';

/** The module in this thread of Node, without a worker around it. */
export class NodeCore {
  static async start() {
    const core = new NodeCore();
    core.messages = [];
    core.module = await createRequire(import.meta.url)(bin + 'maup.js')({
      wasmBinary: readFileSync(bin + 'maup.wasm'),
      message: text => core.messages.push(JSON.parse(text)),
    });
    core.studio = core.module._maup_create(0);
    return core;
  }
  async ask(request) {
    this.messages = [];
    const text = JSON.stringify(request),
      bytes = this.module.lengthBytesUTF8(text) + 1,
      place = this.module._malloc(bytes);
    this.module.stringToUTF8(text, place, bytes);
    const answer = this.module.UTF8ToString(this.module._maup_answer(this.studio, place));
    this.module._free(place);
    return JSON.parse(answer);
  }
  end() {
    this.module._maup_destroy(this.studio);
  }
}
