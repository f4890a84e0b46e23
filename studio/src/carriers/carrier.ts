import type {Answer, Failure, Message, Request, Trouble, TroubleKind} from '../contract';
import type {Lines} from '../lines';

/** Brings requests to a session and answers back. It never throws: what fails is an answer with its trouble. */
export interface Carrier {
  request<T>(request: Request, onMessage: (message: Message) => void, signal: AbortSignal): Promise<Answer<T>>;
  /** ms that a request may go on after it is not wanted any more: what a cancel costs the session. */
  readonly grace: number;
  readonly files?: Files;
}

/** `folder`: its name; `open`: the file that the program was started with. */
export interface Listing {
  files: string[];
  folder: string;
  open: string;
}
/** `alike`: its lines end alike. */
export interface StoredFile extends Lines {
  version: string;
  alike: boolean;
}
export type Saved =
  {saved: true; version: string} | {saved: false; theirs: StoredFile} | {saved: null; trouble: Trouble};

/** Files below the folder that was opened; only where there is a server. */
export interface Files {
  list(): Promise<Listing>;
  read(path: string): Promise<StoredFile | Trouble>;
  /** Refused with the other text where the file is not the one of `version` any more; null: the file must not exist. */
  write(path: string, lines: Lines, version: string | null): Promise<Saved>;
}

export function failure(kind: TroubleKind, message: string, reason = '', help = ''): Failure {
  return {ok: false, kind, trouble: {code: '', message, reason, help}};
}
export const cancelled = (): Failure => failure('cancelled', 'It was cancelled.');
