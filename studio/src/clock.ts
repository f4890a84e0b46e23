import type {RunAnswer} from './contract';

/** The time that drawing and plots show, in s from the first moment of the run. */
export class Clock {
  s = 0;
  playing = false;
  repeat = false;
  duration = 0;
  rate = 1;
  pleasant = 1; // the rate at which a run takes a pleasant time to watch
  first = 0; // the time of the first moment
  way: 1 | -1 = 1;
  private before = 0;
  private listeners: (() => void)[] = [];

  onTick(listener: () => void): void {
    this.listeners.push(listener);
  }
  get now(): number {
    return this.first + this.way * this.s;
  }

  take(run: RunAnswer, fresh: boolean): void {
    const {times} = run,
      last = times[times.length - 1] ?? 0;
    this.first = times[0] ?? 0;
    this.way = last < this.first ? -1 : 1;
    this.duration = Math.abs(last - this.first);
    const pleasant =
      this.duration >= 2 && this.duration <= 120 ? 1 : 10 ** Math.round(Math.log10(this.duration / 15 || 1));
    if (fresh || pleasant !== this.pleasant) this.rate = pleasant * (fresh ? 1 : this.rate / this.pleasant);
    this.pleasant = pleasant;
    this.seek(fresh ? 0 : this.s);
  }

  /** While it plays the next frame tells. */
  seek(s: number): void {
    this.s = Math.min(this.duration, Math.max(0, s));
    if (!this.playing) this.tell();
  }

  play(on: boolean): void {
    if (on === this.playing || (on && this.duration <= 0)) return;
    this.playing = on;
    if (on) {
      if (this.s >= this.duration) this.s = 0;
      this.before = performance.now();
      requestAnimationFrame(stamp => this.step(stamp));
    }
    this.tell();
  }

  private step(stamp: number): void {
    if (!this.playing) return;
    this.s = Math.min(this.duration, this.s + Math.min(0.1, Math.max(0, stamp - this.before) / 1000) * this.rate);
    this.before = stamp;
    if (this.s >= this.duration) this.repeat ? (this.s = 0) : (this.playing = false);
    this.tell();
    if (this.playing) requestAnimationFrame(next => this.step(next));
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
