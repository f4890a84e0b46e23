// What a user does with a page, and what a test reads from it.
import {settled} from './harness.mjs';

export const setSlider = (page, name, value, rest = true) =>
  page.locator(`.value[data-name="${name}"] input[type=range]`).evaluate(
    (slider, [x, rests]) => {
      slider.value = x;
      slider.dispatchEvent(new Event('input', {bubbles: true}));
      if (rests) slider.dispatchEvent(new Event('change', {bubbles: true}));
    },
    [String(value), rest],
  );
export const field = (page, name) =>
  page.locator(`.value[data-name="${name}"] input[type=number]`).inputValue().then(Number);
export const typeAtEnd = async (page, text) => {
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+End');
  await page.keyboard.insertText(text);
};
export const text = page =>
  page
    .locator('.cm-content')
    .evaluate(
      content =>
        content.cmTile?.view?.state.doc.toString() ?? content.cmView?.view?.state.doc.toString() ?? content.innerText,
    );
export const energies = page => page.locator('#conserved-body .drift').first().innerText();

/** Another model by its address. What is changed is left. */
export async function toExample(page, name) {
  await page.evaluate(one => {
    document.body.dataset.settled = 'false';
    location.hash = `#example=${one}`;
  }, name);
  await page.waitForFunction(() => document.querySelector('dialog[open]') || document.body.dataset.settled === 'true');
  if (await page.locator('dialog[open]').count()) await leave(page);
  await settled(page);
}
export const leave = page => page.locator('dialog[open] button', {hasText: 'Leave them'}).click();

/** Requests of this kind wait until `go`; each is told from the data that it carries. */
export async function hold(page, wanted) {
  const waiting = [];
  await page.route('**/api/request*', async route => {
    if (!wanted(route.request().postDataJSON())) return route.fallback();
    await new Promise(go => waiting.push(go));
    await route.continue().catch(() => {}); // the page may have ended it
  });
  return {
    waiting,
    go: () => {
      for (const one of waiting.splice(0)) one();
    },
  };
}

/** Requests of this kind come so many ms later. */
export const delay = (page, wanted, ms) =>
  page.route('**/api/request*', async route => {
    if (!wanted(route.request().postDataJSON())) return route.fallback();
    await new Promise(go => setTimeout(go, ms));
    await route.continue().catch(() => {}); // the page may have ended it
  });

/** Requests of this kind get this answer. */
export const answer = (page, wanted, content) =>
  page.route('**/api/request*', route =>
    wanted(route.request().postDataJSON())
      ? route.fulfill({contentType: 'text/event-stream', body: `event: answer\ndata: ${JSON.stringify(content)}\n\n`})
      : route.fallback(),
  );
export const outOfTime = {
  ok: false,
  kind: 'budget',
  trouble: {code: '', message: 'It did not come within 1 s.', reason: '', help: ''},
};

/** Waits until no question is on its way. */
export const answered = page => page.waitForFunction(() => !document.querySelector('#busy').classList.contains('busy'));

/** Waits until these words stand at this place. */
export const shows = (page, what) =>
  page.waitForFunction(
    ([place, words]) => new RegExp(words).test(document.querySelector(place)?.innerText ?? ''),
    what,
  );
