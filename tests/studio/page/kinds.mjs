// Models of other kinds than a system that moves from its start: each a case as in cases.mjs.
import {inflateSync} from 'node:zlib';
import {check} from './harness.mjs';
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
  shown(page, page.locator(`${where} g[shape-rendering="crispEdges"]`).first().locator('rect').nth(band), 0.5 / (25 - band));

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
      check(`${name}: what finds them is said`, (await stage.innerText()).includes(`maup action ${name}.lag`));
      check(`${name}: no run is offered`, (await stage.locator('button', {hasText: 'Run'}).count()) === 0);
      for (const id of ['start-group', 'section', 'transport', 'run-facts', ...(inTime ? [] : ['modes', 'run-group'])])
        check(`${name}: no #${id}`, await page.locator(`#${id}`).isHidden());
      await page.locator('#export-button').click();
      const offered = await page.locator('dialog li small').allInnerTexts();
      check(`${name}: files of a motion are not offered`, offered.join() === '.lag,LaTeX', offered);
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
