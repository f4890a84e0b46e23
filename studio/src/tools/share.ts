import {linesOf} from '../lines';

/** What a link holds. It stands behind #, which no browser sends anywhere. */
export interface Shared {
  text: string;
  set?: Record<string, string>;
  start?: Record<string, string>;
  name?: string;
}

async function through(bytes: Uint8Array, stream: GenericTransformStream): Promise<Uint8Array> {
  const piped = new Blob([bytes as BlobPart])
    .stream()
    .pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}

export async function encodeShared(shared: Shared): Promise<string> {
  const packed = await through(new TextEncoder().encode(JSON.stringify(shared)), new CompressionStream('deflate-raw'));
  let binary = '';
  for (const byte of packed) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

/** Null where the link is broken. */
export async function decodeShared(code: string): Promise<Shared | null> {
  try {
    const binary = atob(code.replaceAll('-', '+').replaceAll('_', '/'));
    const text = new TextDecoder('utf-8', {fatal: true}).decode(
      await through(
        Uint8Array.from(binary, c => c.charCodeAt(0)),
        new DecompressionStream('deflate-raw'),
      ),
    );
    const shared = JSON.parse(text) as Partial<Shared> | null;
    if (!shared || typeof shared.text !== 'string') return null;
    return {
      text: linesOf(shared.text).text,
      set: words(shared.set),
      start: words(shared.start),
      name: typeof shared.name === 'string' ? shared.name.slice(0, 80) : undefined,
    };
  } catch {
    return null;
  }
}

function words(values: unknown): Record<string, string> {
  if (typeof values !== 'object' || values === null) return {};
  return Object.fromEntries(
    Object.entries(values).filter((entry): entry is [string, string] => typeof entry[1] === 'string'),
  );
}
