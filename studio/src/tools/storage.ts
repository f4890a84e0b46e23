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

const prefix = 'maupertuis-studio-draft-',
  most = 8; // tabs whose texts are kept

/** Each tab has its own: two of them do not write over each other. A reload keeps the name. */
function tabName(): string {
  try {
    const name = sessionStorage.getItem('maupertuis-studio-tab') ?? String(Math.random()).slice(2);
    sessionStorage.setItem('maupertuis-studio-tab', name);
    return name;
  } catch {
    return 'one';
  }
}

export class Storage_ {
  readonly works: boolean;
  private readonly tab = tabName();

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

  /** What this tab had, else what was written last in any. */
  read(): Draft | null {
    const own = this.draft(prefix + this.tab);
    return own ?? this.drafts()[0]?.draft ?? null;
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
