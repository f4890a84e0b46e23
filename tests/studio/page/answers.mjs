// Answers that come late, too late, or not at all: each a case as in cases.mjs.
import {check, gripNear, settled} from './harness.mjs';
import {answer, delay, hold, outOfTime, setSlider, shows, typeAtEnd} from './steps.mjs';

const full = request => request.do === 'run' && request.frames > 1000,
  quick = request => request.do === 'run' && request.frames < 1000;
const unfold = (page, ...parts) =>
  page.evaluate(ids => {
    for (const id of ids) document.getElementById(id).open = true;
  }, parts);
const opacity = (page, place) => page.locator(place).evaluate(one => getComputedStyle(one).opacity);

/** Waits until the page ends this request; false where it does not. */
const ended = (page, kind) =>
  page
    .waitForEvent('requestfailed', {predicate: one => one.postDataJSON()?.do === kind, timeout: 3000})
    .then(() => true)
    .catch(() => false);

export const answers = {
  async 'values end searches'({open}, variant) {
    if (variant.name !== 'server') return;
    const page = await open();
    let moves = 0;
    await unfold(page, 'section');
    for (const [kind, ask, place] of [
      ['modes', () => unfold(page, 'modes'), '#modes-body'],
      ['conserved', () => page.locator('#conserved-body >> text=Search for more').click(), '#conserved-body'],
      ['section', () => page.locator('#section-form button[type=submit]').click(), '#section-body'],
      ['expectations', () => unfold(page, 'expectations'), '#expectations-body'],
    ]) {
      const held = await hold(page, request => request.do === kind),
        end = ended(page, kind);
      await ask();
      while (held.waiting.length === 0) await page.waitForTimeout(20);
      await setSlider(page, 'l1', 1.1 + 0.1 * ++moves, false);
      check(`${kind}: a value ends it`, await end);
      held.go();
      await page.unroute('**/api/request*');
      await settled(page);
      check(`${kind}: nothing went wrong`, (await page.locator(`${place} .message.error`).count()) === 0);
      if (kind === 'section') await shows(page, [place, 'belonged to other values']);
      else await page.evaluate(id => document.getElementById(id).removeAttribute('open'), kind);
    }
    const held = await hold(page, full),
      end = ended(page, 'run');
    await setSlider(page, 'l1', 0.9);
    while (held.waiting.length === 0) await page.waitForTimeout(20);
    await setSlider(page, 'l1', 0.8);
    check('a long run: a value ends it', await end);
    await page.waitForTimeout(200);
    held.go();
    await page.unroute('**/api/request*');
    await settled(page);
    await page.context().close();
  },

  async 'what is found belongs to its values'({open}) {
    const page = await open();
    await unfold(page, 'modes', 'phase-space', 'section');
    await page.waitForSelector('#modes-body table');
    await page.waitForSelector('#phase-space-body math');
    await page.locator('#conserved-body >> text=Search for more').click();
    await settled(page);
    await page.locator('#section-count').fill('10');
    await page.locator('#section-form button[type=submit]').click();
    await shows(page, ['#section-body p', '^10 crossings']);
    await settled(page);
    // While a value moves nothing stands there that was found for the one before.
    await setSlider(page, 'l1', 1.3, false);
    await page.waitForTimeout(20);
    check('no modes of former values', (await page.locator('#modes-body table').count()) === 0);
    check('no momenta of former values', (await page.locator('#phase-space-body math').count()) === 0);
    check('no section of former values', (await page.locator('#section-body svg').count()) === 0);
    await shows(page, ['#section-body', 'belonged to other values']);
    await page.waitForSelector('#modes-body table');
    await settled(page);
    await page.context().close();
  },

  async 'late answers'({open}, variant, picture) {
    if (variant.name !== 'server') return;
    const page = await open();
    const energy = () => page.locator('#conserved-body .drift').first().innerText(),
      before = await energy();
    let held = await hold(page, full);
    await setSlider(page, 'l1', 1.5);
    await page.waitForSelector('#motion.stale');
    for (const part of ['#drawing', '#plots', '#conserved-body'])
      check(`${part} of former values is pale`, (await opacity(page, part)) === '0.5', await opacity(page, part));
    await page.locator('#pin-button').click();
    await shows(page, ['#word', 'not there yet']);
    check('a run of former values is not pinned', (await page.locator('#pins li').count()) === 0);
    await picture(page, 'late');
    held.go();
    await page.unroute('**/api/request*');
    await settled(page);
    check('then it is that of the new ones', (await energy()) !== before);
    check('and looks so', (await page.locator('.stale').count()) === 0);

    // An answer to the text before comes after that to the text.
    held = await hold(page, request => request.do === 'equations');
    await page.locator('.cm-content').click();
    await typeAtEnd(page, '\nlet first = 1');
    while (held.waiting.length === 0) await page.waitForTimeout(20);
    await page.waitForSelector('#equations.stale');
    check('it is told whose equations stand there', /text before/.test(await page.locator('#stale').innerText()));
    await page.unroute('**/api/request*');
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => !document.querySelector('#equations.stale'));
    held.go();
    await settled(page);
    check('no message', await page.locator('#stale').isHidden());

    // A run that cannot be: what is drawn and known of the one before looks so.
    await typeAtEnd(page, '\nstart θ1 = 1/0');
    await page.waitForSelector('#stage-trouble .message.error, #messages .message.error');
    await page.waitForSelector('#motion.stale');
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+z');
    await settled(page);
    check('and not after it is mended', (await page.locator('.stale').count()) === 0);
    await page.context().close();
  },

  async 'of one text'({open}, variant) {
    if (variant.name !== 'server') return;
    const page = await open({hash: '#example=pendulum'}),
      conserved = () => page.locator('#conserved-body').innerHTML();
    check('the energy holds g', /<mi>g<\/mi>/.test(await conserved()), await conserved());
    let held = await hold(page, full);
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+a');
    await page.keyboard.insertText(
      'param m = 1 kg, k = 4 N/m\ncoord x : length\npoint P mass m at (x, 0)\nV = 1/2 k x^2\nstart x = 1 m\nrun 5 s\n',
    );
    await page.waitForFunction(() => /<mi>k<\/mi>/.test(document.querySelector('#equations-body .numbered').innerHTML));
    await page.waitForTimeout(100);
    check('beside new equations stands no energy of the text before', !/<mi>g<\/mi>/.test(await conserved()));
    held.go();
    await page.unroute('**/api/request*');
    await settled(page);

    // What was wrong with a run is not told of the next one.
    await page.locator('#run-group > summary').click();
    const run = async duration => {
      await page.locator('#duration').fill(duration);
      await page.keyboard.press('Enter');
    };
    await run('5 J');
    await page.waitForSelector('#stage-trouble .message');
    held = await hold(page, full);
    await run('5 s');
    await page.waitForFunction(() => !document.querySelector('#stage-trouble .message'), null, {timeout: 3000});
    held.go();
    await page.unroute('**/api/request*');
    await settled(page);
    await page.context().close();
  },

  async 'slow motions'({open}, variant, picture) {
    if (variant.name !== 'server') return;
    const page = await open();
    await answer(page, quick, outOfTime);
    const held = await hold(page, full);
    await setSlider(page, 'l1', 1.4, false);
    await shows(page, ['#stage-trouble', 'longer than a slider waits']);
    check('what helps is told', /rest/.test(await page.locator('#stage-trouble .help').innerText()));
    check('the motion of former values looks so', await page.locator('#motion.stale').isVisible());
    await picture(page, 'slow');
    while (held.waiting.length === 0) await page.waitForTimeout(20);
    held.go();
    await page.unroute('**/api/request*');
    await settled(page);
    check('then it is there', (await page.locator('#stage-trouble .message, .stale').count()) === 0);

    // Runs that take longer than the next move come all the same, one after the other.
    const energies = new Set();
    await delay(page, quick, 150);
    for (let i = 0; i < 30; ++i) {
      await setSlider(page, 'l1', 1.2 + 0.01 * i, false);
      await page.waitForTimeout(40);
      energies.add(await page.locator('#conserved-body .drift').first().innerText());
    }
    check('the motion follows', energies.size >= 4, [...energies]);
    await page.unroute('**/api/request*');
    await settled(page);

    await answer(page, request => request.do === 'pose', outOfTime);
    const grip = await gripNear(page, '#drawing', [0.5, 0.5]);
    await page.mouse.move(...grip);
    await page.mouse.down();
    await page.mouse.move(grip[0] + 20, grip[1] + 10, {steps: 4});
    await shows(page, ['#word', 'less far']);
    await page.mouse.up();
    await page.unroute('**/api/request*');
    await settled(page);
    await page.context().close();
  },
};
