// What a user does in the studio, each as a case over any variant: (browser, variant, picture) → checks.
import {readFileSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {axe, check, gripNear, root, settled} from './harness.mjs';
import {answered, energies, field, setSlider, text, toExample, typeAtEnd} from './steps.mjs';

const require = createRequire(join(root, 'studio/package.json'));

export const cases = {
  async typing({open}, variant, picture) {
    const page = await open({hash: '#example=pendulum'});
    await typeAtEnd(page, '\nlet U = m g l cos θ\nevent low when θ = 0 recrd');
    await page.waitForSelector('#messages .message.error');
    check('a mistake is underlined', (await page.locator('.cm-lintRange-error, .cm-lintPoint-error').count()) > 0);
    check('what stands there is said to be of an older text', await page.locator('#stale').isVisible());
    await picture(page, 'mistake');
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => !document.querySelector('#messages .message.error'));
    await settled(page);

    await typeAtEnd(page, '\nlet W = m g h_0 ');
    await page.waitForSelector('#messages .message.error .what');
    check('an unknown name is told', /h_0/.test(await page.locator('#messages').innerText()));
    await page.keyboard.press('Control+z');
    await settled(page);

    await typeAtEnd(page, '\nlet h = 9,81 m');
    await page.waitForSelector('#messages .fix', {timeout: 10_000});
    const before = await text(page);
    await page.locator('#messages .fix').first().click();
    await page.waitForFunction(() => !document.querySelector('#messages .message.error'));
    check('a fix changes the text', (await text(page)) !== before, before);

    await page.keyboard.press('Control+End');
    await page.keyboard.type('\nlet w = the', {delay: 30});
    // theta finds θ
    await page.waitForFunction(
      () => /θ/.test(document.querySelector('.cm-tooltip-autocomplete')?.textContent ?? ''),
    );
    await picture(page, 'completion');
    await page.keyboard.press('Escape');

    await page.keyboard.type('ta + atan2(θ, ', {delay: 10});
    await page.waitForFunction(() => /atan2/.test(document.querySelector('#signature').textContent));
    check(
      'a call shows its arguments',
      (await page.locator('#signature b').innerText()) === 'x',
      await page.locator('#signature').innerText(),
    );
    await page.locator('.cm-content .tok-coordinate').first().hover();
    await page.waitForSelector('.cm-tooltip .markdown');
    check(
      'hover says what a name is',
      /angle|coordinate/.test(await page.locator('.cm-tooltip .markdown').innerText()),
    );
    await page.context().close();
  },

  async rename({open}) {
    const page = await open({hash: '#example=pendulum'});
    await page.locator('.cm-content .tok-coordinate').first().click();
    await page.keyboard.press('F2');
    await page.locator('dialog input').fill('φ');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() =>
      [...document.querySelectorAll('.tok-coordinate')].some(one => one.textContent.startsWith('φ')),
    );
    await settled(page);
    check('the equations have the new name', (await page.locator('#equations-body').innerHTML()).includes('φ'));
    await page.keyboard.press('Control+End');
    await page.keyboard.insertText('\nlet U = m g l cos φ');
    await settled(page);
    await page.keyboard.press('F12');
    await page.waitForFunction(() => /^coord φ/.test(document.querySelector('.cm-activeLine').textContent));
    await page.keyboard.press('Control+End');
    await page.keyboard.insertText('\nlet   W=m g   l');
    await settled(page);
    await page.locator('#format-button').click();
    await page.waitForFunction(() => /let W = m g l/.test(document.querySelector('.cm-content').textContent));
    await settled(page);
    check('the old one is gone', !(await text(page)).includes('coord θ'));
    for (let i = 0; i < 8 && !(await text(page)).includes('coord θ'); ++i) await page.keyboard.press('Control+z');
    await page.waitForFunction(() =>
      [...document.querySelectorAll('.tok-coordinate')].some(one => one.textContent.startsWith('θ')),
    );
    await page.context().close();
  },

  async sliders({open}, variant, picture) {
    const page = await open();
    const energy = await energies(page),
      svg = () =>
        page
          .locator('#plots canvas')
          .first()
          .evaluate(canvas => canvas.toDataURL().length);
    await svg();
    for (const value of [1.1, 1.2, 1.3, 1.4]) await setSlider(page, 'l1', value, false);
    await setSlider(page, 'l1', 1.5);
    await settled(page);
    check('the number follows its slider', (await field(page, 'l1')) === 1.5);
    check('the energy follows', (await energies(page)) !== energy, energy);
    check(
      'its drift stays at rounding',
      /drift\s*\d+(\.\d+)?·10⁻¹[⁴⁵⁶⁷]/.test((await energies(page)).replace(/\s+/g, ' ')),
      await energies(page),
    );
    // An independent value: V = −(m1 + m2) g l1 cos θ1 − m2 g l2 cos θ2 at rest.
    const deg = Math.PI / 180,
      wanted = -2 * 9.81 * 1.5 * Math.cos(120 * deg) - 9.81 * Math.cos(-10 * deg);
    check(
      'the energy is that of the closed form',
      Math.abs(parseFloat((await energies(page)).replace('value', '').replace('−', '-')) - wanted) <
        1e-6 * Math.abs(wanted),
      [await energies(page), wanted],
    );
    await page.locator('#pin-button').click();
    await setSlider(page, 'θ1', 60);
    await settled(page);
    check('the start follows', Math.abs((await field(page, 'θ1')) - 60) < 1e-9);
    check('a run is pinned', (await page.locator('#pins li').count()) === 1);
    await picture(page, 'pinned');
    await page.locator('#apply-values').click();
    await settled(page);
    const written = await text(page);
    check(
      'values are written into the text',
      /l1 = 1\.5 m/.test(written) && /θ1 = 60 deg/.test(written),
      written.slice(0, 700),
    );
    check('then nothing is changed', (await page.locator('.value.changed').count()) === 0);
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+z');
    await settled(page);
    check('undo takes them back', /l1 = 1 m/.test(await text(page)));
    await page.context().close();
  },

  async drag({open}, variant, picture) {
    const page = await open({hash: '#example=parallelogram'});
    const grip = await gripNear(page, '#drawing', [0.5, 0.5]);
    check('a point can be taken hold of', grip !== null);
    if (!grip) return;
    const before = await page
      .locator('#starts input[type=number]')
      .evaluateAll(list => list.map(one => Number(one.value)));
    await page.mouse.move(...grip);
    await page.mouse.down();
    for (let i = 1; i <= 10; ++i) {
      await page.mouse.move(grip[0] + 5 * i, grip[1] + 3 * i);
      await page.waitForTimeout(30);
    }
    await page.waitForTimeout(200);
    await picture(page, 'dragged');
    await page.mouse.up();
    await settled(page);
    const after = await page
      .locator('#starts input[type=number]')
      .evaluateAll(list => list.map(one => Number(one.value)));
    check('several start values moved together', after.filter((x, i) => Math.abs(x - before[i]) > 1e-3).length >= 2, [
      before,
      after,
    ]);
    check(
      'no message came',
      (await page.locator('#stage-trouble .message').count()) === 0,
      await page.locator('#stage-trouble').innerText(),
    );
    await page.context().close();
  },

  async 'drag meets the circle'({open}) {
    const page = await open({hash: '#example=pendulum'});
    const grip = await gripNear(page, '#drawing', [0.5, 0.9]),
      box = await page.locator('#drawing').boundingBox();
    check('the bob can be taken hold of', grip !== null);
    if (!grip) return;
    await page.mouse.move(...grip);
    await page.mouse.down();
    // Straight down from the pivot, as far as the sheet goes: the bob comes to hang at rest.
    for (let i = 1; i <= 12; ++i) {
      await page.mouse.move(
        grip[0] + ((box.x + box.width * 0.48 - grip[0]) * i) / 12,
        grip[1] + ((box.y + box.height - 8 - grip[1]) * i) / 12,
      );
      if (i < 12) await answered(page); // the place of the last is on its way when it is let go
    }
    await page.mouse.up();
    await settled(page);
    check('θ is small where the bob was pulled down', Math.abs(await field(page, 'θ')) < 15, await field(page, 'θ'));
    await page.context().close();
  },

  async scrub({open}, variant, picture) {
    const page = await open();
    const time = () => page.locator('#time').innerText();
    await page.locator('#scrub').evaluate(scrub => {
      scrub.value = '0.5';
      scrub.dispatchEvent(new Event('input'));
    });
    check('scrubbing shows the middle', /^10(\.0+)? s$/.test(await time()), await time());
    await page.locator('#drawing').focus();
    await page.keyboard.press('Shift+ArrowRight');
    check('an arrow key goes on', /^11(\.0+)? s$/.test(await time()), await time());
    await page.keyboard.press('Space');
    await page.waitForTimeout(500);
    await page.keyboard.press('Space');
    const played = parseFloat(await time());
    check('space plays', played > 11.2 && played < 13, played);
    const box = await page.locator('#plots canvas').first().boundingBox();
    await page.mouse.click(box.x + 62 + (box.width - 76) * 0.25, box.y + 40);
    check('a click in a plot jumps', Math.abs(parseFloat(await time()) - 5) < 0.1, await time());
    await picture(page, 'scrubbed');
    await page.keyboard.press('Home');
    await page.context().close();
  },

  async 'plots that grow'({open}) {
    const page = await open({still: false});
    const until = time =>
      page.waitForFunction(least => parseFloat(document.querySelector('#time').textContent) > least, time);
    const play = page.locator('#play');
    await until(1);
    await page.locator('#to-start').click(); // what was passed begins anew
    if ((await play.getAttribute('aria-label')) === 'Play') await play.click();
    await until(0.5);
    await play.click();
    const drawn = () =>
      page
        .locator('#plots .chart canvas')
        .evaluateAll(all =>
          all.filter(one => one.getBoundingClientRect().top < innerHeight).map(one => one.toDataURL()),
        );
    const grown = await drawn();
    await page.setViewportSize({width: 1602, height: 900});
    await page.waitForTimeout(200);
    await page.setViewportSize({width: 1600, height: 900});
    await page.waitForTimeout(300);
    const atOnce = await drawn();
    const differ = grown.map((picture, i) => picture !== atOnce[i]);
    check('a plot that grew is that which is drawn at once', grown.length > 1 && !differ.includes(true), differ);
    await page.context().close();
  },

  async 'frames while sliders move'({open}) {
    const page = await open({still: false});
    await page.locator('.cm-content').click();
    const {rate, frames, drawn} = await page.evaluate(async () => {
      const slider = document.querySelector('.value[data-name="l1"] input[type=range]'),
        begin = performance.now();
      let frames = 0,
        drawn = 0;
      const context = document.querySelector('#drawing').getContext('2d'),
        clear = context.clearRect;
      context.clearRect = function (...box) {
        ++drawn;
        clear.apply(this, box);
      };
      await new Promise(done =>
        requestAnimationFrame(function step(now) {
          ++frames;
          slider.value = String(1 + 0.4 * Math.sin(now / 300));
          slider.dispatchEvent(new Event('input'));
          if (now - begin < 2000) requestAnimationFrame(step);
          else done();
        }),
      );
      delete context.clearRect;
      return {rate: (frames / (performance.now() - begin)) * 1000, frames, drawn};
    });
    console.log(`frames a second while a slider moves: ${rate.toFixed(0)}`);
    check('with the answers that come each frame is drawn once', drawn <= frames + 1, [drawn, frames]);
    await settled(page);
    await page.context().close();
  },

  async equations({open}, variant, picture) {
    const page = await open();
    await page.locator('#derivation > summary').click();
    await page.waitForSelector('#derivation-body details');
    await page.locator('#derivation-body details > summary').nth(2).click();
    check('a step unfolds with its rule', (await page.locator('#derivation-body details[open] .rule').count()) > 0);
    await page.locator('#equations-body >> text=Copy LaTeX').click();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    check('LaTeX is copied', copied.includes('\\ddot{\\theta}_1'), copied.slice(0, 200));
    await page.locator('#modes > summary').click();
    await page.waitForSelector('#modes-body table');
    check('modes are shown', (await page.locator('#modes-body .mode, #modes-body figure').count()) > 0);
    await page.locator('#phase-space > summary').click();
    await page.waitForSelector('#phase-space-body math');
    await page.locator('#expectations > summary').click();
    await page.waitForSelector('#expectations-body .checks li', {timeout: 60_000});
    check('every expectation holds', (await page.locator('#expectations-body .bad').count()) === 0);
    await page.locator('#derivation').scrollIntoViewIfNeeded();
    await picture(page, 'derivation');
    await page.locator('#section > summary').click();
    await page.locator('#section-count').fill('100');
    await page.locator('#section-form button[type=submit]').click();
    await page.waitForFunction(
      () => /^100 crossings/.test(document.querySelector('#section-body p')?.textContent ?? ''),
      null,
      {timeout: 60_000},
    );
    await page.locator('#section-body').scrollIntoViewIfNeeded();
    await picture(page, 'section');
    await page.context().close();
  },

  async 'equations are seen whole'({open}) {
    const cut = page =>
      page.evaluate(() =>
        [...document.querySelectorAll('#equations-body .mathematics, #equations-body .formula')]
          .filter(one => one.getBoundingClientRect().top < innerHeight && one.scrollWidth > one.clientWidth + 1)
          .map(one => [one.textContent.slice(0, 30), one.scrollWidth, one.clientWidth]),
      );
    for (const name of ['coupled_pendulums', 'robot_arm']) {
      const page = await open({hash: `#example=${name}`});
      await page.waitForTimeout(100);
      check(`${name}: nothing is cut off`, (await cut(page)).length === 0, await cut(page));
      const sizes = await page
        .locator('#equations-body .numbered .mathematics')
        .evaluateAll(all => all.map(one => getComputedStyle(one).fontSize));
      check(`${name}: the equations have one size`, sizes.length > 1 && new Set(sizes).size === 1, sizes);
      const size = () =>
        page
          .locator('#equations-body .mathematics')
          .first()
          .evaluate(one => parseFloat(getComputedStyle(one).fontSize));
      const narrow = await size();
      await page.setViewportSize({width: 2600, height: 900});
      await page.waitForTimeout(300);
      check(`${name}: with more room it is as large as ever`, (await size()) > narrow, [narrow, await size()]);
      await page.context().close();
    }
  },

  async share({open}, variant) {
    const page = await open({hash: '#example=pendulum'});
    await setSlider(page, 'l', 0.7);
    await settled(page);
    await page.locator('#share-button').click();
    await page.waitForFunction(() => location.hash.startsWith('#m='));
    const link = page.url(),
      own = await text(page);
    const other = await open({hash: new URL(link).hash});
    check('a link carries the text', (await text(other)) === own);
    check('and the values', (await field(other, 'l')) === 0.7);
    const broken = await open({hash: new URL(link).hash.slice(0, -7), wait: false});
    await broken.waitForSelector('#word.shown.trouble');
    check('a broken link is told', /broken/.test(await broken.locator('#word').innerText()));
    await settled(broken);
    for (const one of [page, other, broken]) await one.context().close();
  },

  async keeping({open}) {
    const page = await open({hash: '#example=pendulum'});
    await typeAtEnd(page, '\n# kept');
    await page.waitForTimeout(700);
    await page.reload();
    await settled(page);
    check('the text is there after a reload', /# kept/.test(await text(page)));
    await page.context().close();
    const one = await open({hash: '#example=pendulum'}),
      two = await one.context().newPage();
    await two.goto(one.url());
    await settled(two);
    await typeAtEnd(one, '\n# first tab');
    await typeAtEnd(two, '\n# second tab');
    await one.waitForTimeout(700);
    for (const [tab, mark] of [
      [one, '# first tab'],
      [two, '# second tab'],
    ]) {
      await tab.reload();
      await settled(tab);
      check(`each tab keeps its own text: ${mark}`, (await text(tab)).endsWith(mark));
    }
    await one.context().close();
    const poor = await open({storage: false});
    check('a browser without storage is told', /no storage/.test(await poor.locator('#document-state').innerText()));
    await poor.context().close();
  },

  async 'a file in two tabs'({open}, variant) {
    if (!variant.folder) return;
    const page = await open({allow: ['409']}),
      file = join(variant.folder, 'pendulum.lag'),
      original = readFileSync(file, 'utf8');
    await page.locator('#open-button').click();
    await page
      .locator('dialog li button', {hasText: /^pendulum.lag/})
      .first()
      .click();
    await settled(page);
    await typeAtEnd(page, '\n# mine');
    await page.keyboard.press('Control+s');
    await page.waitForFunction(() => /Saved/.test(document.querySelector('#word').textContent));
    check('it is saved', /# mine/.test(readFileSync(file, 'utf8')));
    await typeAtEnd(page, '\n# more');
    writeFileSync(file, `${original}\n# theirs\n`);
    await page.keyboard.press('Control+s');
    await page.waitForSelector('dialog .both');
    check(
      'both texts are shown',
      /# theirs/.test(await page.locator('dialog .both').innerText()) &&
        /# more/.test(await page.locator('dialog .both').innerText()),
    );
    await page.locator('dialog button', {hasText: "Keep this page's"}).click();
    await page.waitForFunction(() => /Saved/.test(document.querySelector('#word').textContent));
    await page.waitForFunction(() => document.querySelector('#document-state').textContent === '');
    check('the one that was chosen is saved', /# more/.test(readFileSync(file, 'utf8')));
    writeFileSync(file, original);
    await page.evaluate(() => dispatchEvent(new Event('focus')));
    await page.waitForFunction(() => /changed elsewhere/.test(document.querySelector('#word').textContent));
    check('a file that changed is read again', !/# more/.test(await text(page)));
    await page.context().close();
  },

  async exports({open}) {
    const page = await open({hash: '#example=pendulum'});
    for (const [label, ending, inside] of [
      ['CSV', '.csv', 'θ'],
      ['LaTeX', '.tex', '\\ddot'],
      ['A page with everything', '.html', '<math'],
      ['.lag', '.lag', 'system pendulum'],
    ]) {
      await page.locator('#export-button').click();
      const [download] = await Promise.all([
        page.waitForEvent('download'),
        page.locator('dialog li button', {hasText: label}).first().click(),
      ]);
      const content = readFileSync(await download.path(), 'utf8');
      check(`export ${label}`, download.suggestedFilename().endsWith(ending) && content.includes(inside), [
        download.suggestedFilename(),
        content.slice(0, 100),
      ]);
    }
    for (const [label, magic] of [
      ['PNG', '\x89PNG'],
      ['SVG', '<svg'],
    ]) {
      await page.locator('#export-button').click();
      const [download] = await Promise.all([
        page.waitForEvent('download'),
        page.locator('dialog li button', {hasText: label}).last().click(),
      ]);
      check(
        `export ${label}`,
        readFileSync(await download.path())
          .toString('latin1')
          .includes(magic),
        download.suggestedFilename(),
      );
    }
    await page.context().close();
  },

  async lecture({open}, variant, picture) {
    const page = await open();
    await page.keyboard.press('l');
    await page.waitForSelector('#lecture .line.now');
    for (let i = 0; i < 6; ++i) await page.keyboard.press('ArrowRight');
    check(
      'seven lines on',
      /^7 \//.test(await page.locator('#lecture output').innerText()),
      await page.locator('#lecture output').innerText(),
    );
    await page.keyboard.press('ArrowLeft');
    check('and one back', /^6 \//.test(await page.locator('#lecture output').innerText()));
    await picture(page, 'lecture');
    await page.keyboard.press('End');
    await page.keyboard.press('Escape');
    await page.waitForFunction(() => !document.querySelector('#lecture'));
    await page.context().close();
    // Every line is seen whole, at the width of a hall and of a phone.
    for (const width of [1600, 400]) {
      const board = await open({width, hash: '#example=cart_pendulum'}),
        cut = [];
      await board.locator('#lecture-button').click();
      await board.waitForSelector('#lecture .line.now');
      const count = Number((await board.locator('#lecture output').innerText()).split('/')[1]);
      for (let i = 1; i < count; ++i) {
        await board.keyboard.press('ArrowRight');
        const over = await board.evaluate(() => {
          const line = document.querySelector('#lecture .line.now');
          const all = [line, ...line.querySelectorAll('.mathematics, .formula')];
          return all.some(one => one.scrollWidth > one.clientWidth + 1);
        });
        if (over) cut.push(i + 1);
      }
      check(`${width}: no line of the lecture is cut off`, count > 20 && cut.length === 0, cut);
      await board.context().close();
    }
  },

  async exercises({open}, variant, picture) {
    const page = await open(),
      known = JSON.parse(readFileSync(join(root, 'tests/studio/exercises.json'), 'utf8')),
      verdict = page.locator('#claim-verdict .message');
    const claim = async text => {
      await page.locator('#claim').fill(text);
      await page.keyboard.press('Enter');
      await verdict.waitFor();
      return verdict.innerText();
    };
    await page.locator('#exercises-button').click();
    await picture(page, 'exercises');
    check('twenty exercises', (await page.locator('dialog ol li').count()) === Object.keys(known).length);
    await page.keyboard.press('Escape');
    for (const [i, {right, wrong}] of Object.values(known).entries()) {
      const name = Object.keys(known)[i];
      await page.locator('#exercises-button').click();
      await page.locator('dialog ol li button').nth(i).click();
      await page.waitForSelector('#exercise');
      await settled(page);
      check(`${name}: the equations are hidden`, await page.locator('#equations-body').isHidden());
      check(`${name}: it asks`, /Find|find/.test(await page.locator('#exercise').innerText()));
      const begins = (await page.locator('#claim').getAttribute('placeholder')).replace(/ =.*/, '');
      check(`${name}: it shows how an answer begins`, right[0].includes(begins), [begins, right]);
      const text = await page.evaluate(() => document.querySelector('.cm-content').innerText);
      check(`${name}: no note after the model comments on the answer`, !/^coord[^]*^note/m.test(text), text);
      const told = await claim(wrong[0][0]);
      check(
        `${name}: a wrong claim is told with its pitfall`,
        /Not yet/.test(told) && told.toLowerCase().includes(wrong[0][1].toLowerCase()),
        told,
      );
      check(`${name}: the answer is not given`, !told.includes(right[0].split('=')[1].trim()), told);
      if (i === 0) await picture(page, 'exercise');
      check(`${name}: a right one is right`, /Right/.test(await claim(right[0])));
    }
    for (const nothing of ['0 = 0', "s'' = s''"])
      check(`${nothing} says nothing`, /Not yet.*same formula/s.test(await claim(nothing)), nothing);
    check('nor is another one asked for', /equation of X/.test(await claim("(M + m) X'' + m cos α s'' = 0")));
    check('what is no equation is told', /\S/.test(await claim("x'' = = 2")));
    await picture(page, 'exercise-right');
    await page.locator('#exercise >> text=Show the equations').click();
    check('the equations are there again', await page.locator('#equations-body').isVisible());
    await page.locator('h1').click();
    await page.keyboard.press('l');
    await page.waitForSelector('#lecture .line.now');
    check('a note stands beside its step', /\S/.test(await page.locator('#lecture .note').innerText()));
    await picture(page, 'lecture-note');
    await page.context().close();
  },

  async 'bad input'({open}, variant) {
    const page = await open({hash: '#example=pendulum'});
    // A text of 10 MB is refused with a word, and the page lives.
    await page.locator('.cm-content').evaluate(content => {
      const view = content.cmTile?.view ?? content.cmView?.view;
      view.dispatch({
        changes: {from: view.state.doc.length, insert: '\n' + '# a long line that says nothing\n'.repeat(330_000)},
      });
    });
    await page.waitForSelector('#equations-body .message.error', {timeout: 30_000});
    check('a text of 10 MB is told', /long/.test(await page.locator('#equations-body').innerText()));
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => !document.querySelector('#equations-body .message.error'), null, {
      timeout: 30_000,
    });
    await settled(page);

    // A run without end is stopped by its budget; the page answers meanwhile.
    await page.locator('#run-group > summary').click();
    await page.locator('#duration').fill('1e9 s');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('#stage-trouble .message') !== null, null, {
      timeout: 60_000,
    });
    const told = await page.locator('#stage-trouble').innerText();
    check('why it ends, and what helps', /not finished|not come within/.test(told) && /shorter|less/.test(told), told);
    await page.locator('#duration').fill('');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('#stage-trouble .message') === null, null, {
      timeout: 60_000,
    });

    // A start that is no number.
    await typeAtEnd(page, '\nstart θ = 0/0');
    await page.waitForSelector('.message.error');
    await page.context().close();
  },

  async widths({open}, variant, picture) {
    for (const dark of [false, true])
      for (const [width, height] of [
        [400, 800],
        [1000, 760],
        [1600, 900],
      ]) {
        const page = await open({width, height, dark}),
          name = `${width}${dark ? '-dark' : ''}`;
        const panes =
          width < 760
            ? ['model', 'values', 'motion', 'equations']
            : width < 1200
              ? ['model', 'values', 'equations']
              : ['all'];
        for (const pane of panes) {
          if (pane !== 'all') await page.locator(`#tabs [data-pane=${pane}]`).click();
          await page.waitForTimeout(150);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
          check(`${name} ${pane}: nothing is wider than the screen`, wide <= 0, wide);
          await axe(page, `${name} ${pane}`);
          await picture(page, `${name}-${pane}`);
        }
        await page.context().close();
      }
  },

  async offline({open}, variant) {
    const page = await open({hash: '#example=pendulum', allow: ['ERR_INTERNET_DISCONNECTED']});
    await settled(page); // the core is there
    await page.context().setOffline(true);
    if (variant.name === 'server') {
      await typeAtEnd(page, '\n# on');
      await page.waitForSelector('#equations-body .message.error');
      check('a server that is away is told', /does not answer/.test(await page.locator('#equations-body').innerText()));
      await page.context().setOffline(false);
      await typeAtEnd(page, '\n# again');
      await page.waitForFunction(() => !document.querySelector('#equations-body .message.error'));
    } else {
      await setSlider(page, 'l', 0.7);
    }
    await settled(page);
    await page.context().close();
  },

  async 'values of every kind are written into the text'({open}) {
    const page = await open();
    for (const name of [
      'heavy_top',
      'woodpecker',
      'slider_crank',
      'bead_on_wire',
      'stick_slip',
      'monopole',
      'kepler',
    ]) {
      await toExample(page, name);
      const before = await page.locator('#messages .message.error').count();
      await page
        .locator('#parameters .value')
        .first()
        .locator('input[type=number]')
        .evaluate(field => {
          field.value = String(Number(field.value) * 1.01);
          field.dispatchEvent(new Event('change'));
        });
      await settled(page);
      await page
        .locator('#starts .value')
        .nth(1)
        .locator('input[type=number]')
        .evaluate(field => {
          field.value = String(Number(field.value) + 0.001);
          field.dispatchEvent(new Event('change'));
        });
      await settled(page);
      const times = () => page.locator('#scrub').getAttribute('aria-valuetext'),
        facts = () => page.locator('#conserved-body').innerText();
      const told = [await times(), await facts()];
      await page.locator('#apply-values').click();
      await settled(page);
      check(
        `${name}: nothing is wrong`,
        (await page.locator('#messages .message.error').count()) === before,
        await page.locator('#messages').innerText(),
      );
      check(`${name}: nothing is changed`, (await page.locator('.value.changed').count()) === 0);
      check(
        `${name}: the motion is the same`,
        JSON.stringify(told) === JSON.stringify([await times(), await facts()]),
        [told[1], await facts()],
      );
    }
    await page.context().close();
  },

  async 'without SIMD'({open}, variant) {
    if (!variant.files) return;
    const page = await open({
      wait: false,
      before: one =>
        one.route('**/maup_worker.js', async route => {
          const answer = await route.fetch();
          await route.fulfill({response: answer, body: `WebAssembly.validate = () => false;\n${await answer.text()}`});
        }),
    });
    await page.waitForSelector('#equations-body .message.error');
    check('a browser that is too old is told', /SIMD/.test(await page.locator('#equations-body').innerText()));
    check('the text is there', (await text(page)).includes('system'));
    await page.context().close();
  },

  async 'one file from a disk'({open}, variant) {
    if (!variant.files) return;
    const url = `file://${join(variant.files, 'studio.html')}`;
    const page = await open({url, hash: '#example=pendulum'});
    await setSlider(page, 'l', 0.7);
    await settled(page);
    check(
      'it computes',
      (await field(page, 'l')) === 0.7 && (await page.locator('#certified').innerText()).includes('certified'),
    );
    await page.context().close();
  },

  async dialogs({open}, variant, picture) {
    for (const dark of [false, true]) {
      const page = await open({dark, hash: '#example=pendulum'});
      for (const name of ['open', 'export', 'help', 'exercises']) {
        if (await page.locator(`#${name}-button`).isHidden()) continue;
        await page.locator(`#${name}-button`).click();
        await page.waitForSelector('dialog[open]');
        await axe(page, `the dialog ${name}${dark ? ', dark' : ''}`);
        await picture(page, `dialog-${name}${dark ? '-dark' : ''}`);
        await page.keyboard.press('Escape');
        await page.waitForFunction(() => !document.querySelector('dialog'));
      }
      for (const part of ['derivation', 'modes', 'phase-space', 'run-facts', 'section'])
        await page.locator(`#${part} > summary`).click();
      await page.waitForSelector('#phase-space-body math');
      await settled(page);
      await axe(page, `everything unfolded${dark ? ', dark' : ''}`);
      await page.locator('h1').click();
      await page.keyboard.press('l');
      await page.waitForSelector('#lecture .line.now');
      await axe(page, `the lecture${dark ? ', dark' : ''}`);
      await page.context().close();
    }
  },

  async print({open}, variant, picture) {
    const page = await open({dark: true, hash: '#example=pendulum'});
    await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
    await page.emulateMedia({media: 'print'});
    await page.waitForTimeout(200);
    check('paper has no bar', await page.locator('#bar').isHidden());
    check('paper has the equations', await page.locator('#equations-body math').first().isVisible());
    check(
      'paper is white',
      (await page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--ink'))).trim() ===
        '#1d1b18',
    );
    await page.setViewportSize({width: 800, height: 1600});
    await picture(page, 'print');
    await page.context().close();
  },

  async 'drag in space'({open}, variant, picture) {
    const page = await open({hash: '#example=spherical_pendulum'}),
      grip = await gripNear(page, '#drawing', [0.5, 0.5]);
    check('a point in space can be taken hold of', grip !== null);
    if (!grip) return;
    const before = await page.locator('#starts input[type=number]').evaluateAll(list => list.map(one => one.value));
    await page.mouse.move(...grip);
    await page.mouse.down();
    for (let i = 1; i <= 8; ++i) {
      await page.mouse.move(grip[0] + 8 * i, grip[1] + 4 * i);
      await page.waitForTimeout(40);
    }
    await page.mouse.up();
    await settled(page);
    const after = await page.locator('#starts input[type=number]').evaluateAll(list => list.map(one => one.value));
    check(
      'the start changed',
      before.some((x, i) => x !== after[i]),
      [before, after],
    );
    const view = await page.locator('#drawing').evaluate(canvas => canvas.toDataURL());
    const box = await page.locator('#drawing').boundingBox();
    await page.mouse.move(box.x + 30, box.y + 30);
    await page.mouse.down();
    await page.mouse.move(box.x + 130, box.y + 60, {steps: 5});
    await page.mouse.up();
    check(
      'a drag beside it turns the drawing',
      view !== (await page.locator('#drawing').evaluate(canvas => canvas.toDataURL())),
    );
    await picture(page, 'space');
    await page.context().close();
  },

  async 'corners of curves'() {
    const file = join(root, 'studio/src/plots/straighten.ts'),
      {transformWithOxc} = await import(require.resolve('vite')),
      {code} = await transformWithOxc(readFileSync(file, 'utf8'), file),
      {corners} = await import(`data:text/javascript,${encodeURIComponent(code)}`);
    // Distance of every point to the piece of line that stands for it.
    const farthest = (x, y, kept) => {
      let most = 0;
      for (let k = 0; k + 1 < kept.length; ++k)
        for (let i = kept[k]; i <= kept[k + 1]; ++i) {
          const [ax, ay] = [x[kept[k]], y[kept[k]]],
            [ux, uy] = [x[kept[k + 1]] - ax, y[kept[k + 1]] - ay],
            part = Math.min(1, Math.max(0, ((x[i] - ax) * ux + (y[i] - ay) * uy) / (ux * ux + uy * uy || 1)));
          most = Math.max(most, Math.hypot(x[i] - ax - part * ux, y[i] - ay - part * uy));
        }
      return most;
    };
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
    const shapes = {
      wave: i => [0.2 * i, 90 + 70 * Math.sin(0.02 * i)],
      rest: () => [3, 4],
      noise: i => [0.01 * i, 50 * random()],
      walk: (() => {
        let [x, y] = [0, 0];
        return () => [(x += random() - 0.5), (y += random() - 0.5)];
      })(),
      loop: i => [100 * Math.cos(0.01 * i), 60 * Math.sin(0.03 * i)],
      'there and back': i => [Math.abs(((0.37 * i) % 200) - 100), 0],
      jump: i => [0.1 * i, i % 700 < 350 ? 0 : 80],
    };
    for (const [name, at] of Object.entries(shapes)) {
      const points = Array.from({length: 4000}, (_, i) => at(i)),
        [x, y] = [0, 1].map(k => points.map(p => p[k])),
        kept = corners(x, y, 0.15);
      check(`${name}: no point is farther than it may be`, farthest(x, y, kept) <= 0.15 + 1e-9, farthest(x, y, kept));
      check(`${name}: from the first to the last, in order`, kept[0] === 0 && kept.at(-1) === 3999);
      check(`${name}: each once`, kept.every((k, i) => i === 0 || k > kept[i - 1]));
      if (name === 'wave') check('of a wave few are left', kept.length < 300, kept.length);
      if (name === 'loop') check('of a curve that crosses itself too', kept.length < 1500, kept.length);
    }
    check('one point stays one', corners([1], [1], 0.15).join() === '0');
  },

  async 'colours are those of reports'() {
    const html = readFileSync(join(root, 'src/report/html.cpp'), 'utf8'),
      style = readFileSync(join(root, 'src/plot/style.cpp'), 'utf8');
    const own = readFileSync(join(root, 'studio/src/style/colours.css'), 'utf8').replaceAll(' ', '');
    const themes = html
      .match(/color-scheme:(?:dark|light);[^"]*"\s*(?:"[^"]*"\s*)*/g)
      .map(part => part.replace(/"\s*"?/g, ''));
    check('two themes', themes.length === 2, themes);
    for (const theme of themes)
      for (const rule of theme.split(';').filter(Boolean))
        check(`the page has ${rule}`, own.includes(`${rule.replaceAll(' ', '')};`), rule);
    for (const colour of style
      .match(/_palette\{[^}]*\}/g)
      .join()
      .match(/#[0-9a-f]{6}/g))
      check(`the page has ${colour}`, own.includes(colour));
  },
};
