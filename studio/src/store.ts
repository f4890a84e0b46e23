/** One state object; parts of the page watch keys of it and are told, once for all changes of a task, after it. */
export class Store<T extends object> {
  private watchers: {keys: (keyof T)[]; tell: (state: T) => void}[] = [];
  private changed = new Set<keyof T>();

  constructor(readonly state: T) {}

  update(patch: Partial<T>): void {
    const empty = this.changed.size === 0;
    for (const key of Object.keys(patch) as (keyof T)[]) {
      if (Object.is(this.state[key], patch[key])) continue;
      this.state[key] = patch[key] as T[typeof key];
      this.changed.add(key);
    }
    if (empty && this.changed.size > 0) queueMicrotask(() => this.flush());
  }

  /** `tell` is called now and after each change of one of the keys. */
  watch(keys: (keyof T)[], tell: (state: T) => void): void {
    this.watchers.push({keys, tell});
    tell(this.state);
  }

  private flush(): void {
    const changed = this.changed;
    this.changed = new Set();
    for (const {keys, tell} of this.watchers) if (keys.some(key => changed.has(key))) tell(this.state);
  }
}
