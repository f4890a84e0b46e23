// The address under which the studio opens a model: its text, deflated, in the fragment, which no server sees.
import {deflateRawSync, inflateRawSync} from 'node:zlib';

export const fragmentOf = text => `m=${deflateRawSync(Buffer.from(text, 'utf8'), {level: 9}).toString('base64url')}`;
export const textOfFragment = fragment =>
  inflateRawSync(Buffer.from(fragment.replace(/^#?m=/, ''), 'base64url')).toString('utf8');
