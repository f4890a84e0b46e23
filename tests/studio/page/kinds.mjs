// Models of other kinds than a system that moves from its start: each a case as in cases.mjs.
import {check} from './harness.mjs';
import {toExample} from './steps.mjs';

/** The colour of the middle of the bar beside a map, and the lightness of a corner of the map in motion, 0 to 255. */
const nothing = page =>
  page.evaluate(() => {
    const bar = document.querySelector('#plots .given g[shape-rendering="crispEdges"]'),
      fill = bar.children[12].getAttribute('fill'),
      map = document.querySelector('#plots canvas.map'),
      at = map.getContext('2d').getImageData(map.width >> 1, 2, 1, 1).data;
    return [Math.max(...[1, 3, 5].map(i => parseInt(fill.slice(i, i + 2), 16))), Math.max(at[0], at[1], at[2])];
  });
const hueOf = page =>
  page.evaluate(() => {
    const bar = document.querySelector('#plots .given g[shape-rendering="crispEdges"]');
    return [0, 24].map(i => {
      const [r, , b] = [1, 3, 5].map(k => parseInt(bar.children[i].getAttribute('fill').slice(k, k + 2), 16));
      return r > b ? 'red' : 'blue';
    });
  });

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
    const fill = await page
      .locator('#modes-body g[shape-rendering="crispEdges"]')
      .first()
      .evaluate(bar => bar.children[12].getAttribute('fill'));
    check('maps of modes too', parseInt(fill.slice(1, 3), 16) < 60, fill);
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
