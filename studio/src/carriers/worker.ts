import type {Answer, Message, Request} from '../contract';
import {cancelled, failure, type Carrier} from './carrier';

type FromWorker = {id?: number; message?: Message; answer?: unknown; failed?: string};
interface Waiting {resolve(answer: never): void; onMessage(message: Message): void}

/**
 * The core as WebAssembly in a worker: {id, request} goes there, {id, message} and {id, answer} come back. A worker cannot
 * hear while it computes, so a cancel ends it and starts another, which gets the text that was open.
 */
export class WorkerCarrier implements Carrier {
  readonly grace = 400;
  private worker: Worker | null = null;
  private waiting = new Map<number, Waiting>();
  private ids = 0;
  private opened: Request | null = null;

  constructor(private readonly make: () => Worker) {}

  request<T>(request: Request, onMessage: (message: Message) => void, signal: AbortSignal): Promise<Answer<T>> {
    if (signal.aborted) return Promise.resolve(cancelled());
    const worker = this.ready(request.do === 'open');
    if (request.do === 'open') this.opened = request;
    const id = ++this.ids;
    return new Promise(resolve => {
      this.waiting.set(id, {resolve, onMessage});
      signal.addEventListener('abort', () => {
        if (!this.waiting.delete(id)) return;
        this.end();
        resolve(cancelled());
      });
      worker.postMessage({id, request});
    });
  }

  private ready(opens: boolean): Worker {
    if (this.worker) return this.worker;
    const worker = this.make();
    this.worker = worker;
    worker.onmessage = (event: MessageEvent<FromWorker>) => this.hear(event.data);
    worker.onerror = event => this.lose(event.message);
    if (!opens && this.opened) worker.postMessage({id: 0, request: this.opened});
    return worker;
  }

  private hear({id, message, answer, failed}: FromWorker): void {
    if (failed !== undefined) return this.lose(failed);
    const waiting = this.waiting.get(id ?? 0);
    if (!waiting) return;
    if (message) waiting.onMessage(typeof message === 'string' ? JSON.parse(message) as Message : message);
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
    const trouble = failure('connection', 'The core stopped.', why || 'The browser ended it, perhaps for want of memory.',
                            'It is started anew with the next question.');
    for (const {resolve} of this.waiting.values()) resolve(trouble as never);
    this.waiting.clear();
  }
}
