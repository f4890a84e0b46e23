import type {Ends} from '../lines';

/** What the page keeps in the browser, if the browser lets it. `saved`: as in the state. */
export interface Draft {
  text: string;
  name: string;
  set: Record<string, string>;
  start: Record<string, string>;
  path: string | null;
  version: string;
  saved: string;
  ends?: Ends; // a draft of before has none
  at: number;
}

const prefix = 'maupertuis-studio-draft-',
  tabKey = 'maupertuis-studio-tab',
  most = 8; // tabs whose texts are kept

const anotherName = (): string => String(Math.random()).slice(2);

/** Holds a name for as long as this page lives; false where another page holds it. */
function hold(name: string): Promise<boolean> {
  return new Promise(resolve => {
    const held = (lock: Lock | null): Promise<void> | undefined => {
      resolve(lock !== null);
      return lock ? new Promise(() => {}) : undefined;
    };
    navigator.locks.request(`${tabKey}-${name}`, {ifAvailable: true}, held).catch(() => resolve(true));
  });
}

export class Storage_ {
  readonly works: boolean;
  private tab = anotherName(); // the name of this tab: it writes under this
  private former = this.tab; // the name that it came with: it reads what stands there

  constructor() {
    let works = false;
    try {
      localStorage.setItem('maupertuis-studio-try', '1');
      localStorage.removeItem('maupertuis-studio-try');
      works = true;
    } catch {
      /* none, or full: the page says so */
    }
    this.works = works;
  }

  /**
   * Each tab has a name, so that two of them do not write over each other's text. A reload keeps it. A copy of a tab
   * comes with the name of the other, which holds it: the copy reads the text and takes a name of its own.
   */
  async begin(): Promise<void> {
    try {
      const name = sessionStorage.getItem(tabKey) ?? this.tab;
      this.former = name;
      if (!navigator.locks || (await hold(name))) this.tab = name;
      else await hold(this.tab);
      sessionStorage.setItem(tabKey, this.tab);
    } catch {
      /* a browser without storage: nothing is kept */
    }
  }

  /** What this tab had, else what was written last in any. */
  read(): Draft | null {
    return this.own() ?? this.drafts()[0]?.draft ?? null;
  }
  own(): Draft | null {
    return this.draft(prefix + this.former);
  }

  private draft(key: string): Draft | null {
    try {
      const draft = JSON.parse(localStorage.getItem(key) ?? 'null') as Draft | null;
      return draft && typeof draft.text === 'string' ? draft : null;
    } catch {
      return null;
    }
  }

  private drafts(): {key: string; draft: Draft}[] {
    if (!this.works) return [];
    return Object.keys(localStorage)
      .filter(key => key.startsWith(prefix))
      .map(key => ({key, draft: this.draft(key)}))
      .filter((one): one is {key: string; draft: Draft} => one.draft !== null)
      .sort((a, b) => b.draft.at - a.draft.at);
  }

  /** False where it could not be kept: a text too long for the browser's storage. */
  write(draft: Draft): boolean {
    try {
      localStorage.setItem(prefix + this.tab, JSON.stringify(draft));
      for (const {key} of this.drafts().slice(most)) localStorage.removeItem(key);
      return true;
    } catch {
      return false;
    }
  }

  setting(name: string): string | null {
    try {
      return localStorage.getItem(`maupertuis-studio-${name}`);
    } catch {
      return null;
    }
  }
  setSetting(name: string, value: string): void {
    try {
      localStorage.setItem(`maupertuis-studio-${name}`, value);
    } catch {
      /* it is forgotten with the page */
    }
  }
}
