// Opens a report in headless Chromium and checks that it works: nothing is loaded, nothing is logged, the replay plays,
// time can be moved, tabs and keys work, every scenario opens.
//
//   node check.mjs REPORT.html [--screenshot OUT.png [--at ADDRESS]] [--chromium PATH]
//
// ADDRESS is a place on the page, such as case-03-intersection-straight-left~tuning; a replay is shown at its least gap.
//
// Exit: 0 all is well; 1 a check failed; 2 it could not be run.

import { existsSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const USAGE = 'usage: node check.mjs REPORT.html [--screenshot OUT.png [--at ADDRESS]] [--chromium PATH]';
const MOST_CASES = 60;

function stop(message) {
  console.error(message);
  process.exit(2);
}

const options = { screenshot: null, at: 'overview', chromium: process.env.CHROMIUM ?? '/usr/bin/chromium' };
let report = null;
for (let i = 2; i < process.argv.length; i++) {
  const argument = process.argv[i];
  if (['--screenshot', '--at', '--chromium'].includes(argument)) options[argument.slice(2)] = process.argv[++i] ?? stop(USAGE);
  else if (report === null && !argument.startsWith('-')) report = argument;
  else stop(USAGE);
}
if (report === null) stop(USAGE);
if (!existsSync(report)) stop(`${report}: no such file`);
if (!existsSync(options.chromium)) stop(`${options.chromium}: no Chromium there; give --chromium PATH or set CHROMIUM`);
const { chromium } = await import('playwright-core').catch(() => stop('playwright-core is missing: run `npm ci` in crates/report/tests/browser'));

const address = pathToFileURL(resolve(report)).href;
const problems = [];
let checks = 0;
const check = (holds, what) => {
  checks += 1;
  if (!holds) problems.push(what);
};

const browser = await chromium
  .launch({
    executablePath: options.chromium,
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  })
  .catch((error) => stop(`Chromium does not start: ${error.message}`));

/** A fresh page whose every message, error and request is held against it. */
async function open(settings, hash = '') {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 }, ...settings });
  const page = await context.newPage();
  page.setDefaultTimeout(10_000);
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && problems.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => problems.push(`script: ${error.message}`));
  page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith('data:') && url.split('#')[0] !== address) problems.push(`it asked for ${url.slice(0, 200)}`);
  });
  page.on('dialog', (dialog) => {
    problems.push(`a dialog said: ${dialog.message()}`);
    dialog.dismiss();
  });
  await page.goto(address + hash, { waitUntil: 'load' });
  return page;
}

const time = (section) => section.locator('.scrub').evaluate((input) => Number(input.value));

async function checkPage(page) {
  const found = await page.evaluate(() => {
    const ids = [...document.querySelectorAll('[id]')].map((element) => element.id);
    const named = (element) => element.getAttribute('aria-label') || element.textContent.trim() || element.labels?.[0]?.textContent.trim();
    return {
      twice: ids.filter((id, i) => ids.indexOf(id) !== i),
      unnamed: [...document.querySelectorAll('button, select, input, [role=tab], [role=tabpanel]')]
        .filter((element) => !named(element) && !element.getAttribute('aria-labelledby'))
        .map((element) => element.outerHTML.slice(0, 120)),
      dangling: [...document.querySelectorAll('[aria-controls], [aria-labelledby], [aria-describedby]')].flatMap((element) =>
        ['aria-controls', 'aria-labelledby', 'aria-describedby']
          .flatMap((name) => (element.getAttribute(name) ?? '').split(' ').filter(Boolean))
          .filter((id) => !document.getElementById(id)),
      ),
      links: [...document.querySelectorAll('a[href]')].map((a) => a.getAttribute('href')).filter((href) => !href.startsWith('#') || !document.getElementById(href.slice(1))),
      policy: document.querySelector('meta[http-equiv=Content-Security-Policy]')?.content ?? '',
      wide: document.documentElement.scrollWidth > document.documentElement.clientWidth,
      rows: document.querySelectorAll('#cases tbody tr').length,
      cases: document.querySelectorAll('.page.case').length,
    };
  });
  check(found.twice.length === 0, `ids that stand twice: ${found.twice}`);
  check(found.unnamed.length === 0, `controls without a name: ${found.unnamed}`);
  check(found.dangling.length === 0, `references to ids that are not there: ${found.dangling}`);
  check(found.links.length === 0, `links that lead out of the page or nowhere: ${found.links}`);
  check(found.policy.includes("default-src 'none'") && !found.policy.includes('unsafe'), 'the content security policy is not strict');
  check(!found.wide, 'the overview is wider than a laptop screen');
  check(found.rows === found.cases, `${found.rows} rows, ${found.cases} scenarios`);
  return found.cases;
}

async function checkTable(page) {
  const first = () => page.locator('#cases tbody tr').first().locator('.case-link').getAttribute('href');
  const button = page.locator('#cases .sort').first();
  await button.click();
  await button.click();
  check((await page.locator('#cases th[aria-sort=descending]').count()) === 1, 'sorting twice does not sort downwards');
  const last = await first();
  await button.click();
  check((await page.locator('#cases tbody tr').count()) < 2 || (await first()) !== last, 'sorting does not change the order');
  await page.keyboard.press('/');
  await page.keyboard.type('no scenario is called this');
  check(await page.locator('#case-none').isVisible(), 'a search without hits does not say so');
  await page.locator('#case-reset').click();
  check(await page.locator('#cases').isVisible(), 'the search cannot be taken back');
}

async function checkReplay(page, section) {
  await page.locator('body').click({ position: { x: 3, y: 300 } });
  check((await time(section)) === 0, 'the replay does not start at 0');
  await page.keyboard.press('Space');
  await page.waitForTimeout(700);
  const played = await time(section);
  check(played > 0.2, `the replay does not play: ${played} s after 0.7 s`);
  check((await section.locator('.play').getAttribute('aria-label')) === 'Pause', 'the play button does not turn into a pause button');
  await page.keyboard.press('Space');
  const paused = await time(section);
  await page.waitForTimeout(200);
  check((await time(section)) === paused, 'the replay does not pause');
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  check(Math.abs((await time(section)) - 0.1) < 1e-6, 'one step on is not 0.1 s');
  await page.keyboard.press('Shift+ArrowRight');
  check(Math.abs((await time(section)) - 1.1) < 1e-6, 'one large step on is not 1 s');
  const scrub = section.locator('.scrub');
  await scrub.focus();
  await page.keyboard.press('End');
  const end = await time(section);
  check(end === Number(await scrub.getAttribute('max')), 'the slider does not go to the end');
  check((await section.locator('.clock').textContent()).startsWith(end.toFixed(1)), 'the clock does not tell the time of the slider');
  const cursor = () => section.locator('[data-plot=gap] .plot-cursor').getAttribute('x1');
  const there = await cursor();
  await page.keyboard.press('Home');
  check((await cursor()) !== there, 'the cursor of the plots does not move with the slider');
  const plot = await section.locator('[data-plot=speed] svg').boundingBox();
  await page.mouse.click(plot.x + plot.width / 2, plot.y + plot.height / 2);
  check((await time(section)) > 0, 'a click on a plot does not set the time');
  check((await section.locator('.plot-line').count()) >= 3, 'lines are missing in the plots');
  const drawn = await section.locator('.view:not([hidden]) canvas').first().evaluate((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4 * 97) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    return seen.size;
  });
  check(drawn > 3, `the picture has ${drawn} colours`);
  const views = () => section.locator('.view:not([hidden])').count();
  if (await section.locator('[data-mode=both]').isEnabled()) {
    await section.locator('[data-mode=both]').click();
    check((await views()) === 2, 'side by side does not show two runs');
    await section.locator('[data-mode=before]').click();
    check((await views()) === 1, 'the run as designed is not shown alone');
  }
  for (const camera of ['follow', 'map', 'fit']) await section.locator(`[data-camera=${camera}]`).click();
}

async function checkTabs(page, section) {
  const tabs = section.locator('[role=tab]');
  await tabs.first().focus();
  for (let i = 1; i < (await tabs.count()); i++) {
    await page.keyboard.press('ArrowRight');
    const tab = tabs.nth(i);
    check((await tab.getAttribute('aria-selected')) === 'true', `the arrow key does not reach tab ${i + 1}`);
    check(await tab.evaluate((element) => element === document.activeElement), `tab ${i + 1} does not get the focus`);
    const panel = page.locator(`[id="${await tab.getAttribute('aria-controls')}"]`);
    check(await panel.isVisible(), `the panel of tab ${i + 1} does not show`);
    check((await section.locator('.tab-panel:visible').count()) === 1, 'more than one panel shows');
  }
  await page.keyboard.press('Home');
  const fact = section.locator('tr[data-fact]').filter({ has: page.locator('.from-words') }).first();
  if (await fact.count()) {
    await fact.hover();
    check((await section.locator('.facts tr.on').count()) === 1, 'a fact under the pointer is not marked');
  }
}

async function checkKeys(page) {
  await page.locator('body').click({ position: { x: 3, y: 300 } });
  await page.keyboard.press('?');
  check(await page.locator('#help').isVisible(), 'the question mark does not open the list of keys');
  await page.keyboard.press('Escape');
  check(!(await page.locator('#help').isVisible()), 'Escape does not close the list of keys');
  await page.evaluate(() => (location.hash = 'records'));
  const map = page.locator('#map');
  if (await map.count()) {
    await map.focus();
    const told = () => page.locator('#map-detail').textContent();
    const first = await told();
    for (const key of ['ArrowRight', 'ArrowLeft', 'ArrowUp', 'ArrowDown']) await page.keyboard.press(key);
    await page.keyboard.press('ArrowRight');
    const marks = await page.locator('.mark').count();
    check(first.length > 0 && (marks < 3 || (await told()) !== first || marks === 0), 'the arrow keys do not move on the map');
  }
}

try {
  const page = await open({ colorScheme: 'light' });
  const cases = await checkPage(page);
  if (options.screenshot) {
    const shown = await open({ colorScheme: 'light' }, `#${options.at.replace(/^#/, '')}`);
    await shown.keyboard.press('m');
    await shown.waitForTimeout(200);
    await shown.screenshot({ path: options.screenshot });
  }
  if (cases > 0) await checkTable(page);
  const anchors = await page.locator('.page.case').evaluateAll((all) => all.map((section) => [section.id, section.querySelectorAll('[data-mode]:not(:disabled)').length]));
  const most = Math.max(0, ...anchors.map(([, modes]) => modes));
  const [running] = anchors.find(([, modes]) => modes > 0 && modes === most) ?? [];
  if (running) {
    const link = page.locator(`.case-link[href="#${running}"]`);
    await link.focus();
    await page.keyboard.press('Enter');
    const section = page.locator(`[id="${running}"]`);
    const opened = await section.waitFor({ state: 'visible', timeout: 5000 }).then(() => true, () => false);
    check(opened, 'Enter on a scenario does not open it');
    await checkReplay(page, section);
    await checkTabs(page, section);
    await checkKeys(page);
  }
  for (const [anchor] of anchors.slice(0, MOST_CASES)) {
    await page.evaluate((hash) => (location.hash = hash), anchor);
    const section = page.locator(`[id="${anchor}"]`);
    await section.waitFor({ state: 'visible', timeout: 5000 }).catch(() => check(false, `${anchor} does not open`));
    await page.keyboard.press('m');
    check((await page.locator('.page:visible').count()) === 1, `${anchor} is not alone on the page`);
    check(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth), `${anchor} is wider than a laptop screen`);
  }
  const dark = await open({ colorScheme: 'dark', viewport: { width: 820, height: 900 } }, running ? `#${running}~metrics` : '');
  check(await dark.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth), 'the page is wider than a narrow window');
  const plain = await open({ javaScriptEnabled: false });
  check((await plain.locator('.page:visible').count()) === cases + 4, 'without scripts not all sections show');
} catch (error) {
  problems.push(`the check stopped: ${error.message}`);
} finally {
  await browser.close();
}
if (problems.length) {
  console.error(`${report}: ${problems.length} problem${problems.length === 1 ? '' : 's'}`);
  for (const problem of problems.slice(0, 40)) console.error(`  - ${problem}`);
  process.exit(1);
}
console.log(`${report}: ${checks} checks passed`);
