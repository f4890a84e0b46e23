// What a lecturer shows in class: forces, drags at walls, modes, sections, paper. Each a case as in cases.mjs.
import {axe, check, gripNear, settled} from './harness.mjs';
import {field, shows} from './steps.mjs';

/** The whole text, as if it had been typed. */
async function write(page, text) {
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+A');
  await page.evaluate(words => navigator.clipboard.writeText(words), text);
  await page.keyboard.press('Control+V');
  await page.waitForTimeout(300);
  await settled(page);
}
/** How many pixels of the canvas have this colour, nearly. */
const inked = (page, name) =>
  page.locator('#drawing').evaluate((canvas, variable) => {
    const wanted = getComputedStyle(document.documentElement).getPropertyValue(variable).trim(),
      rgb = [1, 3, 5].map(k => Number.parseInt(wanted.slice(k, k + 2), 16)),
      {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 200 && rgb.every((x, k) => Math.abs(data[i + k] - x) < 12)) ++count;
    return count;
  }, name);

const rod = `system rodded "A rod, pushed"
param m = 1 kg, l = 1 m, g = 9.81 m/s^2, F = 3 N
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
force on P = (F, 0)
start x = 0.6 m, y = -0.8 m
run 2 s
draw O - P
`;
const ladder = `system ladder "Ladder against a wall"
param m = 5 kg, l = 3 m, g = 9.81 m/s^2
coord x, y : length, θ : angle
body rod mass m inertia m l^2/12 at (x, y) rotation angle θ
point foot at (x, y) - l/2 (cos θ, sin θ)
point top at (x, y) + l/2 (cos θ, sin θ)
gravity (0, -g)
contact foot.y >= 0 name floor
contact -top.x >= 0 name wall
start θ = 60 deg, x = -0.75 m, y = 1.299038105676658 m
run 1 s
draw foot - top
`;
const cart = `system cart "Knife-edge cart"
param m = 2 kg, J = 0.1 kg m^2, a = 0.2 m
coord x, y : length, ψ : angle
body cart mass m inertia J at (x + a cos ψ, y + a sin ψ) rotation angle ψ
constraint y' cos ψ - x' sin ψ = 0 name wheels
start x' = 1 m/s, ψ' = 2 rad/s
run 2 s
draw box cart 0.4 m by 0.2 m
`;

/** From the start of the motion, at rest. */
async function dragged(page, by) {
  if ((await page.locator('#play').getAttribute('data-playing')) === 'true') await page.locator('#play').click();
  await page.locator('#scrub').fill('0');
  const at = await gripNear(page, '#drawing');
  await page.mouse.move(...at);
  await page.mouse.down();
  for (let i = 1; i <= 8; ++i) {
    await page.mouse.move(at[0] + (by[0] * i) / 8, at[1] + (by[1] * i) / 8);
    await page.waitForTimeout(40);
  }
  await page.waitForTimeout(300);
  await page.mouse.up();
  await page.waitForTimeout(300);
  await settled(page);
}

export const lessons = {
  async 'all forces are arrows'({open}, variant, picture) {
    const page = await open({allow: ['getImageData']});
    await write(page, rod);
    const weight = '--series-4',
      pushed = '--series-6';
    check('nothing is shown that is not asked for', (await inked(page, weight)) + (await inked(page, pushed)) === 0);
    await page.selectOption('#forces', 'all');
    await page.waitForTimeout(200);
    await settled(page);
    check('the weight is an arrow', (await inked(page, weight)) > 40, await inked(page, weight));
    check('the applied force is one', (await inked(page, pushed)) > 20, await inked(page, pushed));
    await shows(page, ['#force-legend', 'weights[^]*applied forces[^]*longest arrow: [\\d.]+ N']);
    await picture(page, 'forces');
    await axe(page, 'arrows of forces');
    await page.selectOption('#forces', 'none');
    await page.waitForTimeout(100);
    check('none are shown', (await inked(page, weight)) === 0);
    check('nor a legend', await page.locator('#force-legend').isHidden());

    // Forces of V stand where their coordinate moves a place; one that no single arrow stands for is named.
    await page.selectOption('#forces', 'all');
    await write(
      page,
      `system wedge\nparam M = 3 kg, m = 1 kg, k = 9 N/m, c = 5 N/m\ncoord X, s : length\npoint W mass M at (X, 0)
point P mass m at (X + s/2, -s)\nV += 1/2 c X^2\nV += 1/2 k s^2\nstart X = 1 m, s = 1 m\nrun 2 s\n`,
    );
    await shows(page, ['#force-legend', 'forces of V[^]*no arrow alone does what these do: V on s']);
    check('that of X is an arrow', (await inked(page, '--series-1')) > 20, await inked(page, '--series-1'));
    await page.context().close();
  },

  async 'a drag stops at walls and keeps velocities'({open}) {
    const page = await open();
    await write(page, ladder);
    await dragged(page, [90, 60]);
    check('the motion begins', (await page.locator('#stage-trouble').innerText()) === '');
    const [x, angle] = [await field(page, 'x'), ((await field(page, 'θ')) * Math.PI) / 180];
    check('the top is not behind the wall', x + 1.5 * Math.cos(angle) <= 1e-6, x + 1.5 * Math.cos(angle));
    await write(page, cart);
    const rate = await field(page, "ψ'");
    await dragged(page, [-60, -40]);
    check('the rate of the heading stays', Math.abs((await field(page, "ψ'")) - rate) < 1e-6 * Math.abs(rate), [
      rate,
      await field(page, "ψ'"),
    ]);
    await page.context().close();
  },

  async 'modes without a drawing move, and their tables take the keyboard'({open}, variant, picture) {
    const page = await open();
    await write(
      page,
      `system beads "Beads"\nparam m = 2 kg, k = 50 N/m\ncoord x1, x2 : length\nT = 1/2 m (x1'^2 + x2'^2)
V = 1/2 k (x1^2 + (x2 - x1)^2 + x2^2)\nstart x1 = 10 cm\nrun 2 s\n`,
    );
    await page.evaluate(() => (document.getElementById('modes').open = true));
    await page.waitForSelector('#modes-body figure.mode canvas');
    check('each mode can be watched', (await page.locator('#modes-body figure.mode button').count()) === 2);
    await page.locator('#modes-body').scrollIntoViewIfNeeded();
    await picture(page, 'modes-beads');
    const table = page.locator('#modes-body .scroll').first();
    check('the table is reached by Tab', (await table.getAttribute('tabindex')) === '0');
    await axe(page, 'modes of beads');
    await page.context().close();
  },

  async 'a driven motion is cut once in each period'({open}) {
    const page = await open();
    await write(
      page,
      `system driven "Driven"\ndimensionless\nparam γ = 0.5, ω = 1.2\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2
force x = γ cos(ω t)\nstart x = 0.1\nrun 20\n`,
    );
    check('it is offered', (await page.locator('#section-at').inputValue()) === 'sin(ω t) = 0 rising');
    check('one period needs no choice', await page.locator('#section-period').isHidden());
    await write(
      page,
      `system driven "Driven"\ndimensionless\nparam γ = 0.5, ω = 1.2, ν = 0.7\ncoord x : number\nT = 1/2 x'^2
V = 1/2 x^2\nforce x = γ cos(ω t) + sin(ν t)\nstart x = 0.1\nrun 20\n`,
    );
    check('of two one is offered', (await page.locator('#section-drive').inputValue()) === 'sin(ω t) = 0 rising');
    await page.locator('#section > summary').click();
    await page.locator('#section-drive').selectOption('sin(ν t) = 0 rising');
    check('and the other is taken', (await page.locator('#section-at').inputValue()) === 'sin(ν t) = 0 rising');
    await page.locator('#section-at').fill('x = 0');
    check('what is typed is neither', (await page.locator('#section-drive').inputValue()) === '');
    await write(page, rod);
    check('and not where nothing drives', (await page.locator('#section-at').inputValue()) === 'x = 0');
    await page.context().close();
  },

  async 'on paper circles are round'({open}) {
    const page = await open();
    await page.emulateMedia({media: 'print'});
    await page.setViewportSize({width: 794, height: 1123});
    check(
      'the drawing keeps its proportions',
      (await page.locator('#drawing').evaluate(canvas => getComputedStyle(canvas).objectFit)) === 'contain',
    );
    await page.context().close();
  },

  async 'a text that is too long loses its colours, and is not kept for its length'({open}) {
    const page = await open();
    await page.evaluate(() => navigator.clipboard.writeText('# ' + 'x'.repeat(6_000_000)));
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+A');
    await page.keyboard.press('Control+V');
    await shows(page, ['#messages, #stage, body', 'too long']);
    await page.waitForTimeout(800);
    check('no words have colours', (await page.locator('.cm-content [class*="tok-"]').count()) === 0);
    const said = await page.locator('#document-state').innerText();
    check('the cause is the length', !/no storage/.test(said), said);
    await page.context().close();
  },

  async 'a run that was cut is told to be drawn too coarsely'({open}, variant) {
    if (variant.name !== 'server') return;
    const page = await open();
    await write(
      page,
      `system fast "Fast"\nparam m = 1 kg, k = 10 kN/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2
start x = 1 m\nrun 1 h\n`,
    );
    await page.route('**/api/request*', async route => {
      const asked = route.request().postDataJSON();
      if (asked.do !== 'run') return route.fallback();
      const response = await route.fetch(),
        cut = '"ending":{"ok":false,"kind":"interrupted"',
        body = (await response.text()).replace(/"ending":\{"ok":true,"kind":"[^"]*"/, cut);
      await route.fulfill({response, body});
    });
    await page.locator('.value[data-name="m"] input[type=number]').fill('1.1');
    await page.keyboard.press('Enter');
    await page.waitForTimeout(500);
    await settled(page);
    await shows(page, ['#stage-trouble', 'not finished[^]*more often than its curve']);
    await page.context().close();
  },
};
