// Texts that come, go and are kept: each a case as in cases.mjs.
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {check, gripNear, root, settled} from './harness.mjs';
import {field, leave, setSlider, text, toExample, typeAtEnd} from './steps.mjs';

const model = name => readFileSync(join(root, `models/${name}.lag`), 'utf8');
const undo = async (page, times) => {
  await page.locator('.cm-content').click();
  for (let i = 0; i < times; ++i) await page.keyboard.press('Control+z');
};
const openFile = async (page, name) => {
  await page.locator('#open-button').click();
  await page
    .locator('dialog li button', {hasText: new RegExp(`^${name}`)})
    .first()
    .click();
  await settled(page);
};

export const texts = {
  async 'values in the units of the text'({open}, variant) {
    const page = await open({hash: '#example=pendulum'}),
      grip = await gripNear(page, '#drawing', [0.5, 0.9]);
    await page.mouse.move(...grip);
    await page.mouse.down();
    for (let i = 1; i <= 6; ++i) await page.mouse.move(grip[0] - 6 * i, grip[1] + 3 * i);
    await page.waitForTimeout(300);
    await page.mouse.up();
    await settled(page);
    await page.locator('#apply-values').click();
    await settled(page);
    const angle = /start θ = ([-\d.]+) deg/.exec(await text(page));
    check('degrees stay degrees', angle && Math.abs(angle[1] - (await field(page, 'θ'))) < 1e-3, [
      angle?.[0],
      (await text(page)).match(/^start.*$/m)?.[0],
    ]);
    await page.locator('#run-group > summary').click();
    await page.locator('#duration').fill('5');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('#duration').value === '5 s');
    await settled(page);
    check('a number alone is in seconds', (await page.locator('#stage-trouble .message').count()) === 0);
    await page.locator('#duration').fill('5 J');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#stage-trouble .message');
    check('no ticks', !(await page.locator('#stage-trouble').innerText()).includes('`'));
    await page.locator('#share-button').click();
    await page.waitForFunction(() => /link/.test(document.querySelector('#word').textContent));
    const word = await page.locator('#word').innerText();
    check('a link of this machine is said to be one', /this machine alone/.test(word));
    await page.context().close();
  },

  async 'a model is typed'({open}, variant, picture) {
    const page = await open({hash: '#example=pendulum'}),
      lines = [
        'param m = 1 kg, l = 1 m, g = 9.81 m/s^2',
        'coord theta : angle',
        'point bob mass m at l (sin theta, -cos theta)',
        'start theta = 60 deg',
        'run 10 s',
        'draw O - bob, trail bob',
        'expect energy conserved rel 1e-12',
        "let v = x'^2",
        'let U = m g l the', // θ is offered, and was not chosen
      ];
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+a');
    await page.keyboard.press('Delete');
    for (const line of lines) {
      await page.keyboard.type(line, {delay: 80});
      await page.waitForTimeout(250);
      await page.keyboard.press('Enter');
    }
    check('Enter is a new line', (await text(page)) === lines.join('\n') + '\n', await text(page));
    await page.keyboard.type('let w = the', {delay: 30});
    await page.waitForFunction(() => /θ/.test(document.querySelector('.cm-tooltip-autocomplete')?.textContent ?? ''));
    await page.waitForTimeout(150);
    await picture(page, 'offered');
    await page.keyboard.press('Tab');
    check('Tab takes the first', (await text(page)).endsWith('\nlet w = θ'), await text(page));
    await page.keyboard.type(' + the', {delay: 30});
    await page.waitForFunction(() => /θ/.test(document.querySelector('.cm-tooltip-autocomplete')?.textContent ?? ''));
    await page.waitForTimeout(150);
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    check('Enter takes what an arrow chose', (await text(page)).endsWith('\nlet w = θ + θ'), await text(page));
    await page.context().close();
  },

  async 'undo stays in its model'({open}) {
    const page = await open({hash: '#example=pendulum'});
    await typeAtEnd(page, '\n# mine');
    await settled(page);
    await toExample(page, 'kepler');
    await undo(page, 3);
    check('undo does not lead into the model before', (await text(page)) === model('kepler'));
    await typeAtEnd(page, '\n# more');
    await undo(page, 3);
    check('what was typed is undone', (await text(page)) === model('kepler'));
    await settled(page);

    // Values that the page writes into the text are of this model, and are undone.
    await setSlider(page, 'm', 2);
    await settled(page);
    await page.locator('#apply-values').click();
    await settled(page);
    check('values are written', (await text(page)) !== model('kepler'));
    await undo(page, 1);
    check('and undone', (await text(page)) === model('kepler'));
    await settled(page);

    await page.locator('#exercises-button').click();
    await page.locator('dialog ol li button').first().click();
    await page.waitForSelector('#exercise');
    await settled(page);
    const exercise = await text(page);
    await undo(page, 3);
    check('nor from an exercise', (await text(page)) === exercise);
    await page.context().close();
  },

  async 'an exercise on a phone'({open}, variant, picture) {
    const page = await open({width: 400, height: 800, touch: true});
    await page.locator('#exercises-button').tap();
    await page.locator('dialog ol li button', {hasText: 'sliding wedge'}).tap();
    await page.waitForSelector('#claim');
    await settled(page);
    await page.locator('#claim').fill("s'' = g sin ");
    const signs = page.locator('#exercise .signs');
    check('the letters of the model can be typed', /α/.test(await signs.innerText()), await signs.innerText());
    await signs.locator('button', {hasText: 'α'}).tap();
    check('a sign stands where it is typed', (await page.locator('#claim').inputValue()) === "s'' = g sin α");
    check('the field keeps the focus', (await page.evaluate(() => document.activeElement.id)) === 'claim');
    await page.locator('#exercise button[type=submit]').tap();
    await page.waitForSelector('#claim-verdict .error');
    const told = await page.locator('#claim-verdict').innerText();
    check('a verdict is a sentence', /The coupling with X is missing.*\.$/.test(told), told);
    await picture(page, 'phone-exercise');
    await page.context().close();
  },

  async 'a mistake on a phone'({open}, variant, picture) {
    const page = await open({width: 400, height: 800, touch: true, hash: '#example=pendulum'}),
      tab = name => page.locator(`#tabs [data-pane=${name}]`),
      own = await text(page),
      stale = page.locator('#stage-stale');
    check('nothing to mend, nothing to take back', await page.locator('#mistakes').isHidden());
    check('undo has nothing to do', await page.locator('#undo-button').isDisabled());
    await tab('model').tap();
    await typeAtEnd(page, 'let W = m g l missin');
    await page.locator('#model .signs button', {hasText: 'θ'}).tap();
    check('a sign is typed where the text ends', (await text(page)).endsWith('missinθ'), await text(page));
    check('the text keeps the focus', await page.evaluate(() => document.activeElement.closest('#editor') !== null));
    await page.waitForFunction(() => document.getElementById('mistakes').textContent === '1');
    check('the tab tells how many', (await tab('model').getAttribute('aria-label')) === 'Model, 1 to mend');
    check('in the pane of the text its message is enough', await stale.isHidden());
    await tab('motion').tap();
    check('beside the drawing it is said why that is pale', await stale.isVisible());
    await picture(page, 'phone-mistake');
    await tab('model').tap();
    while (await page.locator('#undo-button').isEnabled()) await page.locator('#undo-button').tap();
    check('undo leads back to the text as it was', (await text(page)) === own, await text(page));
    await page.waitForFunction(() => document.getElementById('mistakes').hidden);
    await tab('motion').tap();
    check('the drawing is that of the text again', await stale.isHidden());
    await tab('model').tap();
    await page.locator('#redo-button').tap();
    check('redo does it again', (await text(page)) !== own);
    await page.context().close();
  },

  async 'ends of lines'({open}, variant) {
    if (!variant.folder) return;
    const file = join(variant.folder, 'pendulum.lag'),
      original = readFileSync(file, 'utf8'),
      ended = original.replaceAll('\n', '\r\n'),
      read = () => readFileSync(file, 'utf8');
    writeFileSync(file, ended);
    const page = await open();
    await openFile(page, 'pendulum.lag');
    check('it is not changed by reading', (await page.locator('#document-state').innerText()) === '');
    await page.waitForSelector('.cm-content .tok-coordinate');  // the server tells what a name is
    await settled(page);
    await page.keyboard.press('Control+s');
    await page.waitForFunction(() => /Saved/.test(document.querySelector('#word').textContent));
    check('saved as it was, it is the same to the byte', read() === ended);
    await typeAtEnd(page, 'let W = m g missing');
    await page.waitForSelector('.cm-lintRange-error');
    check(
      'a mistake is underlined where it stands',
      (await page.locator('.cm-lintRange-error').allInnerTexts()).join() === 'missing',
      await page.locator('.cm-lintRange-error').allInnerTexts(),
    );
    await undo(page, 1);
    await typeAtEnd(page, '# one\n# two\n');
    await settled(page);
    await page.keyboard.press('Control+s');
    await page.waitForFunction(() => document.querySelector('#document-state').textContent === '');
    check('new lines end as the others do', read() === `${ended}# one\r\n# two\r\n`, JSON.stringify(read().slice(-60)));
    await typeAtEnd(page, '# kept');
    await page.waitForTimeout(700);
    await page.reload();
    await settled(page);
    await page.keyboard.press('Control+s');
    await page.waitForFunction(() => document.querySelector('#document-state').textContent === '');
    const ends = JSON.stringify(read().slice(-60));
    check('a reload knows how they end', read() === `${ended}# one\r\n# two\r\n# kept`, ends);

    writeFileSync(file, original.replace('\n', '\r\n'));
    await openFile(page, 'pendulum.lag');
    await page.waitForFunction(() => /end in several ways/.test(document.querySelector('#word').textContent));
    writeFileSync(file, original);
    await page.context().close();
  },

  async 'a copy of a tab'({open}) {
    const one = await open({hash: '#example=pendulum'});
    await typeAtEnd(one, '\n# both');
    await one.waitForTimeout(700);
    // A window that a page opens comes with a copy of its sessionStorage, as a duplicated tab does.
    const [two] = await Promise.all([
      one.context().waitForEvent('page'),
      one.evaluate(() => void window.open(location.href)),
    ]);
    await settled(two);
    check('the copy has the text', (await text(two)).endsWith('# both'));
    await typeAtEnd(one, '\n# first tab');
    await typeAtEnd(two, '\n# second tab');
    await one.waitForTimeout(700);
    const kept = await one.evaluate(() =>
      Object.entries(localStorage).flatMap(([key, value]) => (key.includes('draft') ? [JSON.parse(value).text] : [])),
    );
    for (const [tab, mark] of [
      [one, '# both\n# first tab'],
      [two, '# both\n# second tab'],
    ]) {
      const has = kept.some(draft => draft.endsWith(mark));
      check(`the texts of both are kept: ${mark}`, has, kept.map(x => x.slice(-40)));
      await tab.reload();
      await settled(tab);
      check(`each keeps its own text: ${mark}`, (await text(tab)).endsWith(mark), (await text(tab)).slice(-60));
    }
    await one.context().close();
  },

  async 'a link asks'({open}, variant) {
    const page = await open({hash: '#example=pendulum'}),
      follow = hash => page.evaluate(to => void (location.hash = to), hash),
      asked = () => page.waitForSelector('dialog[open]');
    await setSlider(page, 'l', 0.7);
    await settled(page);
    await page.locator('#share-button').click();
    await page.waitForFunction(() => location.hash.startsWith('#m='));
    const link = new URL(page.url()).hash;
    await page.locator('#reset-values').click();
    await typeAtEnd(page, '\n# mine');
    await settled(page);
    for (const hash of [link, '#example=kepler']) {
      await follow(hash);
      await asked();
      await page.keyboard.press('Escape');
      await page.waitForFunction(() => location.hash === '');
      check(`${hash.slice(0, 9)}: the text stays`, (await text(page)).endsWith('# mine'));
    }
    // A link in the place of the page, as typed into the address of the tab and then opened anew.
    await page.waitForTimeout(500);
    await page.goto('about:blank');
    await page.goto(variant.base + link);
    await asked();
    check('what is changed stands there', (await text(page)).endsWith('# mine'));
    await leave(page);
    await page.waitForFunction(() => !document.querySelector('.cm-content').innerText.includes('# mine'));
    await settled(page);
    check('then the link is opened', (await field(page, 'l')) === 0.7);
    await follow('#example=kepler');
    await settled(page);
    await page.waitForFunction(() => document.querySelector('.cm-content').innerText.includes('system kepler'));
    check('nothing is asked where nothing is changed', (await page.locator('dialog[open]').count()) === 0);
    await page.context().close();
  },
};
