// The box "derive your own": its text goes to the studio in the fragment of the address, deflated, which no server sees.
const box = document.getElementById('own'),
  link = document.getElementById('own-open');

async function fragmentOf(text) {
  const deflated = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(deflated).arrayBuffer());
  let binary = '';
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return `m=${btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '')}`;
}

let asked = 0;
box.addEventListener('input', async () => {
  const mine = ++asked,
    fragment = await fragmentOf(box.value);
  if (mine === asked) link.href = `studio/index.html#${fragment}`;
});
