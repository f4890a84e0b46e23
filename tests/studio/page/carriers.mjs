// What brings questions to the core and answers back, with cores that a test makes up: each a case as in cases.mjs.
import {check} from './harness.mjs';
import {answered, shows, text, typeAtEnd} from './steps.mjs';

/** The page over a worker of this script, in pages that share memory with their worker. */
const over = (open, core) =>
  open({
    wait: false,
    before: async page => {
      const headers = {'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp'};
      await page.route(
        url => url.pathname === '/',
        async route => {
          const html = await (await route.fetch()).text(),
            body = html.replace('<html lang="en">', '<html lang="en" data-core="maup_worker.js">');
          await route.fulfill({contentType: 'text/html', headers, body});
        },
      );
      const answer = {contentType: 'text/javascript', headers, body: core};
      await page.route('**/maup_worker.js', route => route.fulfill(answer));
    },
  });

/** A core that knows nothing of any text; `format` says what it writes before it. */
const core = format => `
  let cancel, module, opened = false, formats = 0;
  const known = {diagnostics: [], tokens: [], symbols: [], folding: [], readable: false};
  const answer = (id, more) => postMessage({id, answer: {ok: true, ...known, ...more}});
  const write = (id, insert) => answer(id, {edits: [{from: 0, to: 0, insert}]});
  const format = ${format};
  onmessage = ({data: {start, id, request}}) => {
    if (start) return cancel = start.cancel, module = start.wasm, postMessage({started: {}});
    if (!cancel) return postMessage({failed: 'no shared memory'});
    if (Atomics.load(cancel, 0) === id) return postMessage({id, answer: {ok: false, kind: 'cancelled', trouble: {}}});
    if (request.do === 'open') opened = true;
    request.do === 'format' ? format(id) : answer(id, {});
  };`;
const textIs = (page, word) =>
  page.waitForFunction(one => document.querySelector('.cm-content')?.innerText.includes(one), word);

export const carriers = {
  async 'a worker that was lost'({open}, variant) {
    if (variant.name !== 'server') return;
    // The next worker opens the text as its request 0, which nobody cancelled.
    const page = await over(
      open,
      core(`id => module ? write(id, opened ? '# it is open\\n' : '# no text\\n') : postMessage({failed: 'lost'})`),
    );
    await textIs(page, 'system');
    await page.locator('#format-button').click();
    await shows(page, ['#word', 'core stopped']);
    await page.locator('#format-button').click();
    // The model has comments of its own further down.
    await page.waitForFunction(() => document.querySelector('.cm-content')?.innerText.startsWith('# '));
    check('the next one has the text', (await text(page)).startsWith('# it is open'), (await text(page)).slice(0, 30));
    await page.context().close();
  },

  async 'a server that ended'({open}, variant, picture) {
    if (variant.name !== 'server') return;
    const page = await open({hash: '#example=pendulum', allow: ['ERR_']});
    await page.route('**/api/**', route => route.abort());
    await typeAtEnd(page, '\n# more');
    await page.waitForSelector('#stale:not([hidden])');
    await page.waitForTimeout(300);
    const told = await page.locator('#equations').innerText();
    check('the text has no mistake', !/mistake/.test(told) && (await page.locator('#stage-stale').isHidden()), told);
    check('it is told that nobody answers', (await page.locator('#equations-body .message').count()) > 0, told);
    await picture(page, 'no-server');
    await page.context().close();
  },

  async 'a worker that cannot be fetched'({open}, variant) {
    if (variant.name === 'server') return;
    const page = await open({
      wait: false,
      allow: ['ERR_FAILED'],
      before: page => page.route('**/maup_worker.js', route => route.abort()),
    });
    await shows(page, ['#equations-body', 'could not be loaded']);
    await page.context().close();
  },

  async 'an answer after its cancel'({open}, variant) {
    if (variant.name !== 'server') return;
    // The second question cancels the first, whose answer is sent as its cancel comes.
    const page = await over(
      open,
      core(`id => {
        const late = () => Atomics.load(cancel, 0) === id ? write(id, '# late\\n') : setTimeout(late, 5);
        ++formats === 1 ? late() : write(id, '# second\\n');
      }`),
    );
    await textIs(page, 'system');
    await answered(page);
    await page.locator('#format-button').click();
    await page.waitForSelector('#busy.busy', {state: 'attached'});
    await page.locator('#format-button').click();
    await textIs(page, '# second');
    check('it is let go', !(await text(page)).includes('# late'), (await text(page)).slice(0, 30));
    await page.context().close();
  },
};
