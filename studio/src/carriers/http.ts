import type {Answer, Message, Request, Trouble} from '../contract';
import {endsAlike, fileOf, linesOf, type Lines} from '../lines';
import {cancelled, failure, type Carrier, type Files, type Listing, type Saved, type StoredFile} from './carrier';

const gone: Trouble = {
  code: '',
  message: 'The server of this page does not answer.',
  reason: '`maup studio` was ended, or the machine slept.',
  help: 'Your text is safe in this page. Start `maup studio` again and open the address that it prints.',
};

/** Name of this tab for the server, which keeps a session for each. */
const tab = [...crypto.getRandomValues(new Uint8Array(12))].map(byte => byte.toString(16).padStart(2, '0')).join('');

/** A local `maup studio`: a request is a POST, its answer a stream of events, the last of which is the answer. */
export class HttpCarrier implements Carrier {
  readonly grace = 40;
  readonly files: Files = new HttpFiles();

  async request<T>(request: Request, onMessage: (message: Message) => void, signal: AbortSignal): Promise<Answer<T>> {
    try {
      const response = await fetch(`/api/request?session=${tab}`, {
        method: 'POST',
        headers: {'Content-Type': 'application/json'},
        body: JSON.stringify(request),
        signal,
      });
      if (!response.ok) return refused(response);
      return await this.read<T>(response, onMessage);
    } catch (error) {
      if (signal.aborted) return cancelled();
      return {ok: false, kind: 'connection', trouble: gone};
    }
  }

  private async read<T>(response: Response, onMessage: (message: Message) => void): Promise<Answer<T>> {
    const reader = response.body!.pipeThrough(new TextDecoderStream()).getReader();
    let parts: string[] = [];
    for (;;) {
      const {value, done} = await reader.read();
      if (done) break;
      if (!value.includes('\n')) {
        parts.push(value);
        continue;
      } // a large answer comes in many pieces
      const events = (parts.join('') + value).split('\n\n');
      parts = [events.pop()!];
      for (const event of events) {
        const {kind, data} = readEvent(event);
        if (kind === 'answer') return JSON.parse(data) as Answer<T>;
        if (kind === 'message') onMessage(JSON.parse(data) as Message);
      }
    }
    return failure(
      'connection',
      'The answer broke off.',
      'The session ended before it had answered.',
      'It is started anew with the next question.',
    );
  }
}

function readEvent(text: string): {kind: string; data: string} {
  const lines = text.split('\n'),
    of = (name: string): string[] =>
      lines.filter(line => line.startsWith(name)).map(line => line.slice(name.length).trimStart());
  return {kind: of('event:')[0] ?? 'message', data: of('data:').join('\n')};
}

async function refused(response: Response): Promise<ReturnType<typeof failure>> {
  const body = (await response.json().catch(() => null)) as {trouble?: Trouble} | null;
  if (body?.trouble) return {ok: false, kind: 'connection', trouble: body.trouble};
  if (response.status === 401 || response.status === 403)
    return failure(
      'connection',
      'The server does not know this page.',
      'Its address has a token that is good once.',
      'Open the address that `maup studio` printed, or start it again.',
    );
  return failure('connection', `The server answered with status ${response.status}.`, '', 'Start `maup studio` again.');
}

const nowhere: Listing = {files: [], folder: '', open: ''};
const stored = (file: string, version: string): StoredFile => ({...linesOf(file), alike: endsAlike(file), version});

class HttpFiles implements Files {
  async list(): Promise<Listing> {
    const response = await fetch('/api/files').catch(() => null);
    if (!response?.ok) return nowhere;
    const {files, folder, open} = (await response.json()) as {files: {path: string}[]; folder: string; open?: string};
    return {files: files.map(file => file.path), folder, open: open ?? ''};
  }

  async read(path: string): Promise<StoredFile | Trouble> {
    const response = await fetch(`/api/file?path=${encodeURIComponent(path)}`).catch(() => null);
    if (!response) return gone;
    if (!response.ok) return (await refused(response)).trouble;
    const {text, etag} = (await response.json()) as {text: string; etag: string};
    return stored(text, etag);
  }

  async write(path: string, lines: Lines, version: string | null): Promise<Saved> {
    const condition: Record<string, string> = version === null ? {} : {'If-Match': `"${version}"`};
    const response = await fetch(`/api/file?path=${encodeURIComponent(path)}`, {
      method: 'PUT',
      body: fileOf(lines),
      headers: {'Content-Type': 'text/plain; charset=utf-8', ...condition},
    }).catch(() => null);
    if (!response) return {saved: null, trouble: gone};
    if (response.ok) return {saved: true, version: ((await response.json()) as {etag: string}).etag};
    const answer = (await response
      .clone()
      .json()
      .catch(() => ({}))) as {text?: string | null; etag?: string | null};
    if (response.status === 409 && typeof answer.text === 'string')
      return {saved: false, theirs: stored(answer.text, answer.etag ?? '')};
    return {saved: null, trouble: (await refused(response)).trouble};
  }
}
