// The box "derive your own": its text goes to the studio in the fragment of the address, which no server sees.
import {encodeShared} from '../../studio/src/tools/share.ts';

const box = document.getElementById('own'),
  link = document.getElementById('own-open');

let asked = 0;
box.addEventListener('input', async () => {
  const mine = ++asked,
    code = await encodeShared({text: box.value, name: 'own'});
  if (mine === asked) link.href = `studio/index.html#m=${code}`;
});
