// The site in use: search, light and dark, filter, keyboard, the pendulum, "derive your own", paper.
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {textOfFragment} from '../../site/source/studio.mjs';

export async function checkUse(check, browser, open, site) {
  const finish = async page => {
    check('no message in use', page.noted.length === 0, page.noted);
    await page.context().close();
  };

  // Search by keyboard: / goes to the field, Enter to what stands first.
  let page = await open(browser, 'manual/pictures.html');
  await page.keyboard.press('/');
  check('/ goes to the search', (await page.evaluate(() => document.activeElement.id)) === 'search');
  await page.keyboard.type('zero test');
  await page.waitForSelector('#found [role=option]');
  const found = await page.locator('#found').innerText();
  check('the search finds a page of the theory', /The zero test/.test(found), found);
  await page.keyboard.press('ArrowDown');
  check('the arrow chooses', (await page.locator('#found [aria-selected=true]').count()) === 1);
  await Promise.all([page.waitForURL(/theory\/zero_test/), page.keyboard.press('Enter')]);
  await page.fill('#search', 'zzzzqqqq');
  await page.waitForSelector('#found .none');
  await page.fill('#search', 'E0304');
  await page.waitForFunction(() => document.querySelector('#found b')?.textContent.includes('E0304'));
  check('a code finds its page', (await page.locator('#found b').first().innerText()).startsWith('E0304'));
  await finish(page);

  page = await open(browser, 'theory/taylor.html', {width: 400});
  await page.fill('#search', 'pendulum');
  await page.waitForSelector('#found [role=option]');
  const list = await page.locator('#found').boundingBox();
  check('on a phone what was found is seen whole', list.x >= 0 && list.x + list.width <= 400, list);
  await finish(page);

  // Light and dark: the choice is kept from page to page.
  page = await open(browser, 'theory/taylor.html');
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor),
    light = await paper();
  await page.click('#theme');
  const dark = await paper();
  check('the button changes light to dark', dark !== light);
  await page.goto(page.siteUrl('theory/orbits.html'));
  check('the choice is kept', (await paper()) === dark);
  await page.emulateMedia({media: 'print'});
  check(
    'paper is light',
    (await page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--ink').trim())) ===
      '#1d1b18',
  );
  check('on paper there is no banner', !(await page.isVisible('.banner')));
  await finish(page);

  // The skip link is the first stop and leads to the text.
  page = await open(browser, 'theory/taylor.html');
  await page.keyboard.press('Tab');
  check('the first stop is the skip link', (await page.evaluate(() => document.activeElement.className)) === 'skip');
  await page.keyboard.press('Enter');
  check('it leads to the text', (await page.evaluate(() => document.activeElement.id)) === 'content');
  await finish(page);

  page = await open(browser, 'models/index.html');
  const cards = await page.locator('.card').count();
  await page.fill('#filter', 'kepler');
  const left = await page.locator('.card:visible').count();
  check('the gallery is filtered', left >= 1 && left < 10 && cards >= 100, [left, cards]);
  check(
    'every card has a picture or a formula',
    await page.evaluate(() =>
      [...document.querySelectorAll('.card')].every(card => card.querySelector('img, .katex')),
    ),
  );
  await finish(page);

  await checkModel(check, browser, open);
  await checkPendulum(check, browser, open);
  await checkStudio(check, browser, open, site);
}

async function checkModel(check, browser, open) {
  const page = await open(browser, 'models/double_pendulum.html');
  const picture = () => page.evaluate(() => document.querySelector('#animation canvas').toDataURL());
  const first = await picture();
  await page.click('[data-control=play]');
  await page.waitForFunction(() => Number(document.getElementById('animation').dataset.time) > 0.2);
  await page.click('[data-control=play]');
  check('the drawing of a model moves', (await picture()) !== first);
  check('its equations are set', (await page.locator('#content .katex').count()) >= 2);
  for (const [part, begins] of [
    ['lagrangian', 'L ='],
    ['energy-function', 'h_E ='],
    ['momenta', '\\frac{\\partial L}{\\partial \\dot{\\theta}_1} ='],
  ]) {
    const latex = await page.locator(`#${part} + .formula annotation`).first().textContent();
    check(`${part} is set as a formula`, latex.replace('\\displaystyle ', '').startsWith(begins), latex);
  }
  const steps = page.locator('.derivation .step');
  check('the derivation is folded', (await steps.count()) > 20 && (await steps.first().isHidden()));
  await page.locator('.derivation summary').click();
  check('and unfolds', await steps.last().isVisible());
  check(
    'its tests are shown',
    /All 11 expectations of the model hold/.test(await page.locator('#content').innerText()),
  );
  check('its certificate is shown', /Passed: 4 independent checks/.test(await page.locator('#content').innerText()));
  check('no message while it moves', page.noted.length === 0, page.noted);
  await page.goto(page.siteUrl('models/kink_antikink.html'));
  await page.waitForFunction(() => document.querySelector('#film > svg').getCurrentTime() > 0.1);
  await page.click('#film-play');
  const stopped = await page.evaluate(() => [
    document.querySelector('#film > svg').animationsPaused(),
    document.getElementById('film-play').textContent,
  ]);
  check('the film of a field stops', stopped[0] === true && stopped[1] === 'play', stopped);
  const turned = () => page.evaluate(() => getComputedStyle(document.querySelector('#film > svg')).filter);
  check('a film on light paper is as it was drawn', (await turned()) === 'none', await turned());
  await page.click('#theme');
  check('a film on dark paper is dark', (await turned()).startsWith('invert('), await turned());
  await page.context().close();
}

async function checkPendulum(check, browser, open) {
  const page = await open(browser, 'index.html', {reduced: true});
  const state = () => page.evaluate(() => self.maupPendulum.state),
    own = () => page.evaluate(() => self.maupPendulum.own);
  check('reduced motion: the pendulum rests', (await page.locator('#pendulum-play').innerText()) === 'Play');
  const start = await state();
  await page.click('#pendulum-play');
  await page.waitForFunction(from => Math.abs(self.maupPendulum.state[0] - from) > 0.05, start[0]);
  check('it moves along the run of maup', (await own()) === false);
  await page.click('#pendulum-play');

  // The few lines of the page against the run that the program computed: one second from the start.
  const off = await page.evaluate(() => {
    const rows = JSON.parse(document.getElementById('pendulum-run').textContent),
      at = rows.findIndex(row => Math.abs(row[0] - 1) < 1e-9);
    let y = rows[0].slice(1);
    for (let i = 0; i < 1000; ++i) y = self.maupPendulum.step(y, 0.001);
    return Math.max(...y.map((value, i) => Math.abs(value - rows[at][i + 1])));
  });
  check('the page integrates the same equations', off < 1e-6, off);

  const box = await page.locator('#pendulum .second').boundingBox(),
    hold = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...hold);
  await page.mouse.down();
  await page.mouse.move(hold[0] + 60, hold[1] - 90, {steps: 4});
  const held = await state();
  check('a bob follows the hand, at rest', (await own()) === true && held[3] === 0 && held[1] === 0);
  const bob = await page.locator('#pendulum .second').boundingBox();
  check(
    'it points to the hand',
    Math.abs(Math.atan2(bob.x + bob.width / 2 - hold[0] - 60, bob.y + bob.height / 2 - hold[1] + 90)) < 4,
  );
  await page.mouse.up();
  await page.waitForFunction(from => Math.abs(self.maupPendulum.state[2] - from) > 0.02, held[2]);
  check('let go, it swings on', (await page.locator('#pendulum-says').innerText()).includes('Runge-Kutta'));
  await page.focus('#pendulum .first');
  const before = await state();
  await page.keyboard.press('ArrowRight');
  const after = await state();
  check('keys turn it too', after[1] === 0 && after[3] === 0 && after[0] !== before[0]);
  check('no message of the pendulum', page.noted.length === 0, page.noted);
  await page.context().close();
}

async function checkStudio(check, browser, open, site) {
  const page = await open(browser, 'index.html');
  const text = 'system own\ncoord θ : angle  # ½ € θ\n';
  const old = await page.getAttribute('#own-open', 'href');
  await page.fill('#own', text);
  await page.waitForFunction(before => document.getElementById('own-open').getAttribute('href') !== before, old);
  const link = await page.getAttribute('#own-open', 'href');
  check('the box goes to the studio with its text', textOfFragment(link.split('#')[1]) === text, link);
  await page.goto(page.siteUrl('models/pendulum.html'));
  const href = await page.locator('.button.main').first().getAttribute('href');
  check(
    'a model goes to the studio as it is',
    textOfFragment(href.split('#')[1]) === readFileSync(join(site, 'models/text/pendulum.lag'), 'utf8'),
  );
  await Promise.all([page.waitForURL(/studio\/studio\.html#m=/), page.click('.button.main')]);
  await page.waitForFunction(() => self.opened !== undefined);
  check('from a file the page for disks takes over', (await page.evaluate(() => self.opened)) === 'for disks');
  check('it has the model', page.url().split('#')[1] === href.split('#')[1]);
  check('no message on the way to the studio', page.noted.length === 0, page.noted);
  await page.context().close();
}
