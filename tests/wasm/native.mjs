import {spawn} from 'node:child_process';
import {createInterface} from 'node:readline';
import {project} from './requests.mjs';

/** The session of this machine, by build/bin/session_answers. */
export class Native {
  constructor() {
    this.process = spawn(project + 'build/bin/session_answers', {
      stdio: ['pipe', 'pipe', 'inherit'],
      env: {...process.env, MAUPERTUIS_LLVM_MODULE: '/nowhere'}, // the interpreter: the module has nothing else
    });
    this.waiting = [];
    createInterface({input: this.process.stdout}).on('line', line => this.waiting.shift()?.(JSON.parse(line)));
  }
  ask(request) {
    return new Promise(resolve => {
      this.waiting.push(resolve);
      this.process.stdin.write(JSON.stringify(request) + '\n');
    });
  }
  end() {
    this.process.stdin.end();
  }
}
