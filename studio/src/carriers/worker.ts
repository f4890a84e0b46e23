import type {Answer, Message, Request} from '../contract';
import {cancelled, failure, type Carrier} from './carrier';

type FromWorker = {
  id?: number;
  message?: Message | string;
  answer?: unknown;
  failed?: string;
  started?: WebAssembly.Module;
};
const none = -1; // the number of no request
interface Waiting {
  resolve(answer: never): void;
  onMessage(message: Message): void;
}

/** Where the core comes from: the script of the worker, and the bytes of maup.wasm where it is not to fetch them. */
export interface Core {
  script: string;
  wasm?: ArrayBuffer;
}

/**
 * The core as WebAssembly in a worker: {id, request} goes there, {id, message} and {id, answer} come back
 * (apps/studio_wasm). A worker cannot hear while it computes. Where pages may share memory, the number of a request
 * that stands there ends it; elsewhere a cancel ends the worker and starts another. A new worker gets the compiled
 * module, and the text that was open as its request 0.
 */
export class WorkerCarrier implements Carrier {
  readonly grace: number;
  private worker: Worker | null = null;
  private waiting = new Map<number, Waiting>();
  private ids = 0;
  private opened: Request | null = null;
  private module: WebAssembly.Module | null = null;
  private readonly cancel = globalThis.crossOriginIsolated ? new Int32Array(new SharedArrayBuffer(4)).fill(none) : null;

  constructor(private readonly core: Promise<Core>) {
    this.grace = this.cancel ? 60 : 500;
  }

  async request<T>(request: Request, onMessage: (message: Message) => void, signal: AbortSignal): Promise<Answer<T>> {
    const worker = await this.ready(request.do === 'open').catch((error: Error) => error);
    if (signal.aborted) return cancelled();
    if (worker instanceof Error) return withoutCore(worker.message);
    if (request.do === 'open') this.opened = request;
    const id = ++this.ids;
    return new Promise(resolve => {
      this.waiting.set(id, {resolve, onMessage});
      signal.addEventListener('abort', () => this.giveUp(id));
      worker.postMessage({id, request});
    });
  }

  private giveUp(id: number): void {
    const waiting = this.waiting.get(id);
    if (!waiting) return;
    if (this.cancel) {
      Atomics.store(this.cancel, 0, id);
      return;
    } // its answer says that it was cancelled
    this.waiting.delete(id);
    this.end();
    waiting.resolve(cancelled() as never);
  }

  private async ready(opens: boolean): Promise<Worker> {
    if (this.worker) return this.worker;
    const {script, wasm} = await this.core,
      worker = new Worker(script);
    this.worker = worker;
    worker.onmessage = (event: MessageEvent<FromWorker>) => this.hear(event.data);
    // A script that could not be fetched is an event without a message.
    worker.onerror = event => this.lose((event as Partial<ErrorEvent>).message ?? 'It could not be loaded.');
    worker.postMessage({start: {wasm: this.module ?? wasm, cancel: this.cancel ?? undefined}});
    if (!opens && this.opened) worker.postMessage({id: 0, request: this.opened});
    return worker;
  }

  private hear({id, message, answer, failed, started}: FromWorker): void {
    if (started) this.module = started;
    if (failed !== undefined) return this.lose(failed);
    const waiting = this.waiting.get(id ?? 0);
    if (!waiting) return;
    if (message) waiting.onMessage(typeof message === 'string' ? (JSON.parse(message) as Message) : message);
    if (answer === undefined) return;
    this.waiting.delete(id!);
    waiting.resolve((typeof answer === 'string' ? JSON.parse(answer) : answer) as never);
  }

  private end(): void {
    this.worker?.terminate();
    this.worker = null;
  }

  private lose(why: string): void {
    this.end();
    for (const {resolve} of this.waiting.values()) resolve(withoutCore(why) as never);
    this.waiting.clear();
  }
}

function withoutCore(why: string): ReturnType<typeof failure> {
  if (location.protocol === 'file:' && why.includes('Worker'))
    return failure(
      'connection',
      'A browser starts no worker from a file of the disk.',
      'It treats each file as a site of its own.',
      'Open `studio.html` beside this page, which holds everything in itself.',
    );
  if (why.includes('browser has no'))
    return failure(
      'connection',
      `${why[0].toUpperCase()}${why.slice(1)}.`,
      'The core of Maupertuis is a WebAssembly program that needs it.',
      'Take a browser of 2023 or later, or install Maupertuis and run `maup studio`.',
    );
  return failure(
    'connection',
    'The core stopped.',
    why || 'The browser ended it, perhaps for want of memory.',
    'It is started anew with the next question.',
  );
}

/** The core that stands in the page itself, packed, in two elements that are no scripts for the browser. */
export async function embeddedCore(): Promise<Core> {
  const part = (id: string): string => document.getElementById(id)!.textContent!;
  const packed = Uint8Array.from(atob(part('core-wasm')), c => c.charCodeAt(0));
  const wasm = await new Response(
    new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip')),
  ).arrayBuffer();
  return {script: URL.createObjectURL(new Blob([part('core-worker')], {type: 'text/javascript'})), wasm};
}
