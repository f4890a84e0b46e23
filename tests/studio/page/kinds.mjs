// Models of other kinds than a system that moves from its start: each a case as in cases.mjs.
import {inflateSync} from 'node:zlib';
import {check, settled} from './harness.mjs';
import {toExample} from './steps.mjs';

/** The colour that is shown in an element, this part of its height below its top: a picture of one dot, as PNG. */
async function shown(page, element, part) {
  await element.scrollIntoViewIfNeeded();
  const box = await element.boundingBox(),
    clip = {x: Math.round(box.x + box.width / 2), y: Math.round(box.y + part * box.height), width: 1, height: 1},
    png = await page.screenshot({clip}),
    parts = [];
  for (let at = png.indexOf('IDAT'); at >= 0; at = png.indexOf('IDAT', at + 4))
    parts.push(png.subarray(at + 4, at + 4 + png.readUInt32BE(at - 4)));
  return [...inflateSync(Buffer.concat(parts)).subarray(1, 4)];
}

/** Of the 25 bands of the bar beside a map, from the top: each reaches down to the foot, and the next covers it. */
const bandOf = (page, where, band) =>
  shown(
    page,
    page.locator(`${where} g[shape-rendering="crispEdges"]`).first().locator('rect').nth(band),
    0.5 / (25 - band),
  );

/** The lightness of the middle of the bar beside a map, and of a corner of the map in motion, 0 to 255. */
async function nothing(page) {
  const corner = await page.evaluate(() => {
    const map = document.querySelector('#plots canvas.map'),
      at = map.getContext('2d').getImageData(map.width >> 1, 2, 1, 1).data;
    return Math.max(at[0], at[1], at[2]);
  });
  return [Math.max(...(await bandOf(page, '#plots .given', 12))), corner];
}
const hueOf = async page => {
  const out = [];
  for (const band of [0, 24]) {
    const [r, , b] = await bandOf(page, '#plots .given', band);
    out.push(r > b ? 'red' : 'blue');
  }
  return out;
};

export const kinds = {
  async 'modes of contacts and friction'({open}, variant, picture) {
    const page = await open({hash: '#example=stick_slip'}),
      modes = id => page.locator(`${id} option`).allTextContents(),
      choose = async (id, mode) => {
        await page.locator(id).selectOption(mode);
        await page.waitForFunction(() => document.body.dataset.settled === 'true');
        await settled(page);
      };
    const holds = page.locator('#equations-body .holds');
    check('it is told when the equations hold', /without dry friction/.test(await holds.innerText()));
    await picture(page, 'modes');
    const all = await modes('#mode');
    check('there are modes to choose from', all.length > 2, all);
    await page.locator('#run-group > summary').click();
    await choose('#mode', 'free');
    await page.waitForFunction(() => /stays in it/.test(document.querySelector('#equations-body .holds').innerText));
    for (const id of ['#mode', '#mode-of-equations'])
      check(`in a mode the others stay to be chosen: ${id}`, (await modes(id)).join() === all.join(), await modes(id));
    check('the mode is shown', (await page.locator('#mode').inputValue()) === 'free');
    await page.locator('#reset-values').click();
    await page.waitForFunction(() => !/stays in it/.test(document.querySelector('#equations-body .holds').innerText));
    await settled(page);
    check('and reset leads back', (await page.locator('#mode').inputValue()) === '');
    await choose('#mode-of-equations', all[2]);
    await page.waitForFunction(
      mode => document.querySelector('#equations-body .holds').innerText.includes(mode),
      all[2],
    );
    await page.locator('#lecture-button').click();
    await page.waitForSelector('#lecture .line.now');
    await page.keyboard.press('End');
    check(
      'a lecture tells whose equations they are',
      (await page.locator('#lecture .note').innerText()).includes(all[2]),
      await page.locator('#lecture .note').innerText(),
    );
    await picture(page, 'lecture-mode');
    await page.context().close();
  },

  async 'fields have what can be made of them'({open}, variant, picture) {
    const page = await open({hash: '#example=sine_gordon_kink', width: 400, height: 800, touch: true});
    await page.locator('#tabs [data-pane=values]').tap();
    const top = (await page.locator('#values').boundingBox()).y;
    check('no room is kept for a drawing that is none', top < 160, top);
    await page.locator('#export-button').tap();
    const files = await page.locator('dialog[open] li').allInnerTexts();
    const pictures = /Drawing|Animation|Plot/.test(files.join());
    check('report and motion, but no drawing', files.length === 5 && !pictures, files);
    await page.keyboard.press('Escape');
    await page.evaluate(() => document.getElementById('lecture-button').click());
    await page.waitForSelector('#lecture .line.now');
    check('no empty picture', (await page.locator('#lecture canvas').count()) === 0);
    await picture(page, 'lecture-field');
    await page.context().close();
  },

  async 'a curve with too few points'({open}, variant, picture) {
    const page = await open({hash: '#example=pendulum'}),
      told = () => page.locator('#stage-trouble').innerText();
    const fork = turns => `param m = 1 kg, f = ${turns} 1/s\ncoord x : length\nlet w = 2 pi f\npoint P mass m at (x, 0)
V = 1/2 m w^2 x^2\nstart x = 1 mm\nrun 10 s\n`;
    for (const [turns, few] of [[99.7, true], [10, false], [49.9, true]]) {
      await page.locator('.cm-content').click();
      await page.keyboard.press('Control+a');
      await page.keyboard.insertText(fork(turns));
      await settled(page);
      check(`${turns} turns a second in 10 s`, /more often/.test(await told()) === few, await told());
      if (few) await picture(page, 'coarse');
    }
    await page.context().close();
  },

  async "a body has Euler's equations"({open}, variant, picture) {
    const page = await open({hash: '#example=tumbling_satellite'});
    const lines = await page.locator('#equations-body > .numbered .line').count();
    check('three of ω, four of the quaternion and its norm', lines === 8, lines);
    check('the others fold', (await page.locator('#equations-body details:not([open])').count()) === 1);
    await picture(page, 'rates');
    await page.context().close();
  },

  async 'chaos is told'({open}, variant, picture) {
    const page = await open();
    await page.locator('#run-group > summary').click();
    await page.locator('#duration').fill('200');
    await page.keyboard.press('Enter');
    await page.waitForFunction(
      () => /no digit of the motion is certain/.test(document.querySelector('#stage-trouble').innerText),
      null,
      {timeout: 60_000},
    );
    const told = await page.locator('#stage-trouble').innerText(),
      from = Number(/t = ([\d.]+) s/.exec(told)[1]);
    check('from a time that is well within the run', from > 15 && from < 120, told);
    check('the run says so too', (await page.locator('#motion-body').textContent()).includes('no digit'));
    await picture(page, 'chaos');
    await page.context().close();
  },

  async 'maps of fields follow the theme'({open}, variant, picture) {
    const page = await open({hash: '#example=membrane', dark: true, allow: ['willReadFrequently']});
    await page.waitForSelector('#plots .given svg');
    const first = await nothing(page);
    check('nothing is dark on dark paper', Math.max(...first) < 60, first);
    check('the ends keep their hues', (await hueOf(page)).join() === 'red,blue', await hueOf(page));
    await picture(page, 'map-dark');
    await page.locator('#theme-button').click();
    check('light on light paper', Math.min(...(await nothing(page))) > 230, await nothing(page));
    check('with the same hues', (await hueOf(page)).join() === 'red,blue');
    await page.locator('#theme-button').click();
    check('and dark again', (await nothing(page)).join() === first.join(), await nothing(page));
    await page.locator('#modes > summary').click();
    await page.waitForSelector('#modes-body figure svg');
    const middle = await bandOf(page, '#modes-body', 12);
    check('maps of modes too', Math.max(...middle) < 60, middle);
    await page.context().close();
  },

  async 'paths have no motion'({open}, variant, picture) {
    const page = await open(),
      stage = page.locator('#stage-trouble');
    for (const [name, inTime] of [
      ['brachistochrone', false],
      ['hanging_chain', false],
      ['oscillator_path', true],
    ]) {
      await toExample(page, name);
      check(`${name}: it is said`, /paths between two ends/.test(await stage.innerText()), await stage.innerText());
      await page.waitForSelector('#stage-trouble .paths figure svg');
      const told = await stage.innerText();
      check(`${name}: what they are is told`, /Path 1[^]*S[^]*(minimum|index)/.test(told), told);
      check(`${name}: no run is offered`, (await stage.locator('button', {hasText: 'Run'}).count()) === 0);
      for (const id of ['start-group', 'section', 'transport', 'run-facts', ...(inTime ? [] : ['modes', 'run-group'])])
        check(`${name}: no #${id}`, await page.locator(`#${id}`).isHidden());
      await page.locator('#export-button').click();
      const offered = await page.locator('dialog li small').allInnerTexts();
      const expected = '.lag; A page with everything, for any browser; LaTeX';
      check(`${name}: files of a motion are not offered`, offered.join('; ') === expected, offered);
      await page.keyboard.press('Escape');
    }
    await picture(page, 'path');
    await stage.locator('button').click();
    await page.waitForSelector('#expectations-body .checks li');
    check('its expectations hold', (await page.locator('#expectations-body .bad').count()) === 0);
    await toExample(page, 'pendulum');
    for (const id of ['start-group', 'section', 'transport', 'modes', 'run-group'])
      check(`a pendulum has #${id}`, await page.locator(`#${id}`).isVisible());
    await page.context().close();
  },
};
