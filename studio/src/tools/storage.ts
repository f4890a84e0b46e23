/** What the page keeps in the browser, if the browser lets it. */
export interface Draft {
  text: string;
  name: string;
  set: Record<string, string>;
  start: Record<string, string>;
  path: string | null;
  version: string;
  saved: string;
  at: number;
}

const key = 'maupertuis-studio-draft';

export class Storage_ {
  readonly works: boolean;

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

  read(): Draft | null {
    try {
      const draft = JSON.parse(localStorage.getItem(key) ?? 'null') as Draft | null;
      return draft && typeof draft.text === 'string' ? draft : null;
    } catch {
      return null;
    }
  }

  /** False where it could not be kept: a text too long for the browser's storage. */
  write(draft: Draft): boolean {
    try {
      localStorage.setItem(key, JSON.stringify(draft));
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
