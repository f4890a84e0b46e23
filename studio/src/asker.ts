import type {Answer, Message, Request} from './contract';
import {cancelled, type Carrier} from './carriers/carrier';

interface Job {
  kind: string;
  request: Request;
  rank: number;
  quick: boolean;
  onMessage: (message: Message) => void;
  resolve: (answer: never) => void;
  abort: AbortController;
  begun: number;
}

export interface AskOptions {
  kind?: string;
  quick?: boolean; // of values that move
  onMessage?: (message: Message) => void;
}

/** Which of several questions goes first. */
const ranks: Record<string, number> = {open: 0, pose: 1, run: 3, equations: 2, complete: 1, hover: 2, signature: 2};

/**
 * One question at a time goes to the session, as it answers one at a time. Of one kind only the newest waits. One on
 * its way ends, after the carrier's grace, where a newer one of its kind is asked, where another text is opened, and
 * where the values change that it is about; but a quick one comes to its end before other quick ones, or none would
 * where values move faster than it. What was cancelled gives no answer, not even one that was on its way already.
 */
export class Asker {
  private queue: Job[] = [];
  private current: Job | null = null;
  private listeners: ((busy: string | null) => void)[] = [];

  constructor(private readonly carrier: Carrier) {}

  onBusy(listener: (kind: string | null) => void): void {
    this.listeners.push(listener);
  }

  ask<T>(
    request: Request,
    {kind = request.do, quick = false, onMessage = () => {}}: AskOptions = {},
  ): Promise<Answer<T>> {
    const opens = request.do === 'open';
    for (const job of this.queue.filter(job => job.kind === kind || (opens && dependsOnText(job)))) this.drop(job);
    const {current} = this,
      replaced = current?.kind === kind && !(quick && current.quick);
    if (current && (replaced || (opens && dependsOnText(current)))) this.cancelSoon(current);
    return new Promise<Answer<T>>(resolve => {
      const rank = ranks[request.do] ?? 4;
      this.queue.push({kind, request, rank, quick, onMessage, resolve, abort: new AbortController(), begun: 0});
      this.next();
    });
  }

  /** The values changed: what is asked about the former ones ends, however long it would go on. */
  outdate(): void {
    for (const job of this.queue.filter(aboutValues)) this.drop(job);
    if (this.current && aboutValues(this.current) && !this.current.quick) this.cancelSoon(this.current);
  }

  /** Nobody waits for these any more. */
  cancel(kind: string): void {
    for (const job of this.queue.filter(job => job.kind === kind)) this.drop(job);
    if (this.current?.kind === kind) this.current.abort.abort();
  }

  private drop(job: Job): void {
    this.queue = this.queue.filter(other => other !== job);
    job.resolve(cancelled() as never);
  }

  private cancelSoon(job: Job): void {
    const left = this.carrier.grace - (performance.now() - job.begun);
    setTimeout(
      () => {
        if (this.current === job) job.abort.abort();
      },
      Math.max(0, left),
    );
  }

  private async next(): Promise<void> {
    if (this.current || this.queue.length === 0) return;
    const job = this.queue.reduce((best, one) => (one.rank < best.rank ? one : best));
    this.queue = this.queue.filter(other => other !== job);
    this.current = job;
    job.begun = performance.now();
    for (const tell of this.listeners) tell(job.kind);
    const answer = await this.carrier.request(job.request, job.onMessage, job.abort.signal);
    this.current = null;
    if (this.queue.length === 0) for (const tell of this.listeners) tell(null);
    job.resolve((job.abort.signal.aborted ? cancelled() : answer) as never);
    void this.next();
  }
}

const dependsOnText = (job: Job): boolean =>
  job.request.do !== 'hello' && job.request.do !== 'explain' && job.request.do !== 'open';

/**
 * Equations are those of the text: they come to their end. A file that is exported is that of the values when it was
 * asked for.
 */
const aboutValues = (job: Job): boolean =>
  ['run', 'modes', 'phase_space', 'conserved', 'section', 'expectations'].includes(job.request.do);
