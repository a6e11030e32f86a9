// Opens a report in headless Chromium and checks that it works: nothing is loaded but files of its own scenarios, nothing is
// logged, the replay plays, time can be moved, tabs and keys work, scenarios open, search and filters find, and at three
// sizes of a window nothing is cut off. Prints how long the first screen and a scenario take, and what they weigh.
//
//   node check.mjs REPORT.html [--screenshot OUT.png [--at ADDRESS] [--size WIDTHxHEIGHT]] [--chromium PATH]
//
// ADDRESS is a place on the page, such as case-intersection-straight-left-90101-439~tuning; a replay is shown as it opens.
//
// Exit: 0 all is well; 1 a check failed; 2 it could not be run.

import { existsSync, readFileSync, statSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const USAGE = 'usage: node check.mjs REPORT.html [--screenshot OUT.png [--at ADDRESS] [--size WIDTHxHEIGHT]] [--chromium PATH]';
/** Scenarios that are opened one after the other; of more, as many are taken evenly. */
const MOST_CASES = 30;
/** Sizes of windows: a telephone, a small laptop, a screen. */
const SIZES = [[390, 844], [1024, 700], [1440, 900]];
/** Limits: wide ones for times, as the machine may be busy; what they are on a quiet one stands in bench-runs. [ms], [bytes], [bytes] */
const FIRST_SCREEN_MS = 10000;
const FIRST_SCREEN_BYTES = 5e6;
const HANGS_MS = 5000;
const MEMORY_BYTES = 600e6;

function stop(message) {
  console.error(message);
  process.exit(2);
}

const options = { screenshot: null, at: 'overview', size: '1366x768', chromium: process.env.CHROMIUM ?? '/usr/bin/chromium' };
let report = null;
for (let i = 2; i < process.argv.length; i++) {
  const argument = process.argv[i];
  if (['--screenshot', '--at', '--size', '--chromium'].includes(argument)) options[argument.slice(2)] = process.argv[++i] ?? stop(USAGE);
  else if (report === null && !argument.startsWith('-')) report = argument;
  else stop(USAGE);
}
if (report === null) stop(USAGE);
if (!existsSync(report)) stop(`${report}: no such file`);
if (!existsSync(options.chromium)) stop(`${options.chromium}: no Chromium there; give --chromium PATH or set CHROMIUM`);
const { chromium } = await import('playwright-core').catch(() => stop('playwright-core is missing: run `npm ci` in crates/report/tests/browser'));

const address = pathToFileURL(resolve(report)).href;
const besides = pathToFileURL(join(dirname(resolve(report)), 'report')).href;
const problems = [];
let checks = 0;
const check = (holds, what) => {
  checks += 1;
  if (!holds) problems.push(what);
};

const browser = await chromium
  .launch({
    // Bars take their room, as on most screens.
    ignoreDefaultArgs: ['--hide-scrollbars'],
    executablePath: options.chromium,
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  })
  .catch((error) => stop(`Chromium does not start: ${error.message}`));

/** A fresh page whose every message, error and request is held against it. */
async function open(settings, hash = '') {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 }, ...settings });
  const page = await context.newPage();
  page.asked = [];
  page.setDefaultTimeout(10_000);
  page.setDefaultNavigationTimeout(60_000);
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && problems.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => problems.push(`script: ${error.message}`));
  page.on('request', (request) => {
    const url = request.url();
    const own = url.startsWith(`${besides}/`) && url.endsWith('.js') && request.resourceType() === 'script';
    if (own) page.asked.push(url);
    else if (!url.startsWith('data:') && url.split('#')[0] !== address) problems.push(`it asked for ${url.slice(0, 200)}`);
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
      links: [...document.querySelectorAll('a[href]')].map((a) => a.getAttribute('href')).filter((href) => !href.startsWith('#') || !(document.getElementById(href.slice(1)) || href.startsWith('#case-'))),
      policies: [...document.querySelectorAll('meta[http-equiv=Content-Security-Policy]')].map((meta) => meta.content),
      stems: JSON.parse(document.getElementById('suite-data').textContent).rows.stems,
    };
  });
  check(found.twice.length === 0, `ids that stand twice: ${found.twice}`);
  check(found.unnamed.length === 0, `controls without a name: ${found.unnamed}`);
  check(found.dangling.length === 0, `references to ids that are not there: ${found.dangling}`);
  check(found.links.length === 0, `links that lead out of the page or nowhere: ${found.links}`);
  const [loads, places] = found.policies;
  check(loads?.includes("default-src 'none'") && !found.policies.join().includes('unsafe') && places?.startsWith("script-src 'self' file: "), 'the content security policy is not strict');
  check(page.asked.length === 0, 'a scenario is read before it is looked at');
  return found.stems;
}

/** What runs out of the window or of its own box. */
async function checkSize(page, what) {
  const found = await page.evaluate(() => {
    const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
    const width = document.documentElement.clientWidth;
    const seen = (element) => element.checkVisibility({ checkVisibilityCSS: true }) && !element.closest('.hidden-text, svg, canvas, .sprite, .skip');
    // What may be scrolled sideways by itself, and says so by a bar.
    const scrolls = (element) => element.closest('.table-wrap, pre');
    const cut = [];
    for (const element of document.querySelectorAll('.page.current *, .top *')) {
      if (!seen(element)) continue;
      const name = `${element.tagName.toLowerCase()}.${element.className}`.slice(0, 60);
      const text = (element.getAttribute('aria-label') ?? element.textContent).trim().slice(0, 40);
      const box = element.getBoundingClientRect();
      if (!box.width || !box.height) continue;
      if (!scrolls(element) && (box.left < -1 || box.right > width + 1)) cut.push(`${name} "${text}" ends at ${Math.round(box.right)} of ${width}`);
      const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
      const held = own || element.matches('button, .chip, .tile, th, td');
      if (held && !scrolls(element) && !element.matches('select, option, canvas, .readout *') && element.scrollWidth > element.clientWidth + 2 && getComputedStyle(element).display !== 'inline') {
        cut.push(`${name} "${text}" is ${element.scrollWidth} wide in ${element.clientWidth}`);
      }
    }
    return { wide, cut };
  });
  check(found.wide <= 0, `${what} is ${found.wide} pixels wider than the window`);
  check(found.cut.length === 0, `${what} is cut off: ${found.cut.slice(0, 4).join('; ')}`);
}

const inView = (locator) => locator.evaluate((element) => {
  const box = element.getBoundingClientRect();
  const at = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  return box.top >= 0 && box.bottom <= innerHeight && box.left >= 0 && box.right <= innerWidth && element.contains(at);
});

/** The section of a scenario that was asked for, once its file has come. */
async function opened(page, anchor) {
  const section = page.locator(`[id="${anchor}"].current[data-filled]`);
  await section.waitFor({ state: 'visible', timeout: 5000 });
  return section;
}

async function checkSizes(stems, running) {
  for (const [width, height] of SIZES) {
    const at = `at ${width} x ${height}`;
    const page = await open({ colorScheme: 'light', viewport: { width, height } });
    await checkSize(page, `the overview ${at}`);
    if (stems.length) {
      check(await page.locator('#case-search').isVisible(), `there is no search ${at}`);
      const shown = await page.locator('#cases tbody tr').first().evaluate((row) => [...row.cells].map((cell) => cell.checkVisibility()));
      check(shown.every(Boolean), `a column is hidden ${at}`);
    }
    for (const place of ['records', 'findings', 'about']) {
      await page.evaluate((hash) => (location.hash = hash), place);
      await page.locator(`#${place}.current`).waitFor({ state: 'visible' });
      await checkSize(page, `${place} ${at}`);
    }
    if (!running) continue;
    await page.evaluate((hash) => (location.hash = hash), running);
    const section = await opened(page, running);
    check(await inView(section.locator('.play')), `the play button is out of sight ${at}`);
    check(await inView(section.locator('.scrub')), `the slider is out of sight ${at}`);
    // The widest that a clock can say, whatever this run's length.
    await section.locator('.clock').evaluate((clock) => (clock.textContent = '120.0 / 120.0 s'));
    await checkSize(page, `${running} ${at}`);
    const tabs = section.locator('[role=tab]');
    for (let i = 1; i < (await tabs.count()); i++) {
      await tabs.nth(i).click();
      await checkSize(page, `${running}, tab ${i + 1}, ${at}`);
    }
    await page.context().close();
  }
}

/** What a person waits for: the first screen, and a scenario that is looked at for the first time. */
async function checkSpeed(stems) {
  const page = await open({ colorScheme: 'light', viewport: { width: 1440, height: 900 } });
  await page.waitForTimeout(300);
  const { painted, ready } = await page.evaluate(() => ({
    painted: performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN,
    ready: performance.getEntriesByType('navigation')[0].domContentLoadedEventEnd,
  }));
  const bytes = statSync(report).size;
  console.log(`first screen: painted after ${Math.round(painted)} ms, ready after ${Math.round(ready)} ms, ${bytes} bytes read before it, ${stems.length} scenarios`);
  check(painted < FIRST_SCREEN_MS, `the first screen takes ${Math.round(painted)} ms`);
  check(bytes < FIRST_SCREEN_BYTES, `${bytes} bytes are read before the first screen`);
  if (!stems.length) return;
  const times = [];
  for (const stem of [...new Set([stems[0], stems[stems.length >> 1], stems[stems.length - 1]])]) {
    times.push(await page.evaluate((anchor) => new Promise((resolve) => {
      const start = performance.now();
      const filled = () => document.getElementById(anchor)?.dataset.filled !== undefined;
      const look = () => (filled() ? requestAnimationFrame(() => resolve(performance.now() - start)) : setTimeout(look, 2));
      location.hash = anchor;
      look();
    }), `case-${stem}`));
  }
  console.log(`a scenario opens in ${times.map(Math.round).join(', ')} ms`);
  // The middle one: a busy machine holds up one or the other.
  const middle = [...times].sort((a, b) => a - b)[times.length >> 1];
  check(middle < HANGS_MS, `a scenario takes ${Math.round(middle)} ms to open`);
  const client = await page.context().newCDPSession(page);
  const { metrics } = await client.send('Performance.enable').then(() => client.send('Performance.getMetrics'));
  const memory = await renderers();
  console.log(`memory: ${Math.round(memory / 1e6)} MB in the page's processes, script heap ${Math.round(metrics.find(({ name }) => name === 'JSHeapUsedSize').value / 1e6)} MB`);
  check(memory < MEMORY_BYTES, `the page takes ${Math.round(memory / 1e6)} MB`);
  await page.context().close();
}

/** Memory that the largest of the browser's page processes holds for itself. [bytes] */
async function renderers() {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  const sizes = processInfo.filter(({ type }) => type === 'renderer').map(({ id }) => {
    const field = readFileSync(`/proc/${id}/status`, 'utf8').match(/^VmRSS:\s+(\d+) kB/m);
    return field ? Number(field[1]) * 1024 : 0;
  });
  return Math.max(0, ...sizes);
}

async function checkTable(page, stems) {
  const first = () => page.locator('#cases tbody tr').first().locator('.case-link').getAttribute('href');
  const button = page.locator('#cases .sort').first();
  // A suite of accounts opens with the worst first.
  await page.locator('#case-sort').selectOption('order');
  await button.click();
  check((await page.locator('#cases th[aria-sort=descending]').count()) === 1, 'sorting twice does not sort downwards');
  const last = await first();
  await button.click();
  check(stems.length < 2 || (await first()) !== last, 'sorting does not change the order');
  const keys = await page.locator('#case-sort option').evaluateAll((options) => options.map((option) => option.value));
  for (const key of ['impact', 'harm']) check(keys.includes(key), `the table cannot be sorted by ${key}`);
  for (const key of keys) {
    await page.locator('#case-sort').selectOption(key);
    check((await page.locator('#cases tbody tr').count()) > 0, `sorting by ${key} loses the rows`);
  }
  await page.locator('#case-sort').selectOption('order');
  await page.keyboard.press('/');
  await page.keyboard.type('no scenario is called this');
  check(await page.locator('#case-none').isVisible(), 'a search without hits does not say so');
  await page.locator('#case-reset').click();
  check(await page.locator('#cases').isVisible(), 'the search cannot be taken back');
  const rows = await page.evaluate(() => JSON.parse(document.getElementById('suite-data').textContent).rows);
  const told = rows.operator[1].findIndex((index) => index !== null);
  if (told < 0) return;
  // Every key of the scenario finds it, and nothing that lacks the key is listed.
  const word = rows.words[told].split(' ').pop();
  const words = ['operator', 'city', 'kind'].map((key) => rows[key][0][rows[key][1][told]]).concat(word ? [word] : []);
  for (const key of words) {
    await page.locator('#case-search').fill(key);
    const listed = Number((await page.locator('#case-count').textContent()).split(' ')[0]);
    check(listed > 0, `the search for "${key}" finds nothing`);
    check((await page.locator(`#cases tbody tr[data-row="${told}"]`).count()) === 1 || listed > 60, `the search for "${key}" does not find the scenario that has it`);
  }
  await page.locator('#case-search').fill('');
  for (const key of ['operator', 'city', 'kind', 'injury']) {
    const select = page.locator(`[data-only=${key}]`);
    const shown = await select.isVisible();
    check(shown === rows[key][0].length > 1, `the filter by ${key} ${shown ? 'has nothing to choose from' : 'is not there'}`);
    if (!shown) continue;
    const index = rows[key][1][told];
    await select.selectOption(String(index));
    const wanted = rows[key][1].filter((value) => value === index).length;
    const listed = Number((await page.locator('#case-count').textContent()).split(' ')[0]);
    check(listed === wanted, `the filter by ${key} lists ${listed} of ${wanted}`);
    await page.locator('#case-reset').click().catch(() => select.selectOption(''));
  }
  check((await page.locator('#cases tbody tr').count()) === Math.min(60, stems.length), 'the table does not begin with one slice');
  if (stems.length > 60) {
    await page.locator('#case-more').scrollIntoViewIfNeeded();
    await page.waitForFunction(() => document.querySelectorAll('#cases tbody tr').length > 60, null, { timeout: 3000 }).catch(() => check(false, 'scrolling draws no more rows'));
    await page.evaluate(() => scrollTo(0, 0));
  }
}

async function checkReplay(page, section) {
  await page.locator('body').click({ position: { x: 3, y: 300 } });
  const events = await section.locator('.event').evaluateAll((marks) => marks.map((mark) => [Number.parseFloat(mark.getAttribute('aria-label')), mark.className]));
  check(events.length > 0, 'the slider marks no event');
  check(events.some(([, kind]) => /end|contact/.test(kind)), 'the slider does not mark how the run ends');
  const met = events.find(([, kind]) => /contact|obstacle/.test(kind)) ?? events.find(([, kind]) => /gap/.test(kind));
  if (met) {
    check(Math.abs((await time(section)) - Math.max(0, met[0] - 1.5)) < 0.11, `the replay opens at ${await time(section)} s, the encounter is at ${met[0]} s`);
    check(await section.locator('.event').first().isVisible(), 'the marks of the slider do not show');
  }
  check((await section.locator('.play').getAttribute('aria-label')) === 'Play', 'the replay does not open paused');
  await page.keyboard.press('Home');
  for (const [at] of events.filter(([at]) => at > 0)) {
    await page.keyboard.press('.');
    check(Math.abs((await time(section)) - at) < 0.11, `the key of the next event goes to ${await time(section)} s, not to ${at} s`);
  }
  if (events.length > 1) {
    await page.keyboard.press(',');
    check(Math.abs((await time(section)) - events[events.length - 2][0]) < 0.11, 'the key of the event before does not go there');
    await section.locator('.event').last().click();
    check(Math.abs((await time(section)) - events[events.length - 1][0]) < 0.11, 'a mark does not set the time');
  }
  await page.locator('body').click({ position: { x: 3, y: 300 } });
  await page.keyboard.press('Home');
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
    // Which of them lead somewhere depends on where the first mark lies.
    const seen = new Set([first]);
    for (const key of ['ArrowRight', 'ArrowLeft', 'ArrowUp', 'ArrowDown']) {
      await page.keyboard.press(key);
      seen.add(await told());
    }
    const marks = await page.locator('.mark').count();
    check(first.length > 0 && (marks < 3 || seen.size > 1), 'the arrow keys do not move on the map');
  }
}

try {
  const page = await open({ colorScheme: 'light' });
  const stems = await checkPage(page);
  const anchors = stems.map((stem) => `case-${stem}`);
  if (options.screenshot) {
    const [width, height] = options.size.split('x').map(Number);
    const shown = await open({ colorScheme: 'light', viewport: { width, height } }, `#${options.at.replace(/^#/, '')}`);
    await shown.waitForTimeout(800);
    await shown.screenshot({ path: options.screenshot });
  }
  await checkSpeed(stems);
  if (stems.length) await checkTable(page, stems);
  const every = Math.max(1, Math.ceil(stems.length / MOST_CASES));
  const some = anchors.filter((_, i) => i % every === 0);
  let running = null;
  let most = 0;
  for (const anchor of some) {
    await page.evaluate((hash) => (location.hash = hash), anchor);
    const section = await opened(page, anchor).catch(() => null);
    check(section, `${anchor} does not open`);
    if (!section) continue;
    check((await page.locator('.page:visible').count()) === 1, `${anchor} is not alone on the page`);
    check(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth), `${anchor} is wider than a laptop screen`);
    const modes = await section.locator('[data-mode]:not(:disabled)').count();
    if (modes > most) [running, most] = [anchor, modes];
  }
  check((await page.locator('.page.case').count()) <= 8, 'scenarios that were looked at stay on the page for ever');
  if (running) {
    await page.evaluate(() => (location.hash = 'overview'));
    await page.locator('#case-search').fill(running.replace('case-', ''));
    const link = page.locator(`.case-link[href="#${running}"]`);
    if (await link.count()) {
      await link.focus();
      await page.keyboard.press('Enter');
    } else await page.evaluate((hash) => (location.hash = hash), running);
    // Looked at before: what it shows must be what it shows at first.
    const fresh = await open({ colorScheme: 'light' }, `#${running}`);
    const section = await opened(fresh, running);
    await opened(page, running).catch(() => check(false, 'Enter on a scenario does not open it'));
    await checkReplay(fresh, section);
    await checkTabs(fresh, section);
    await checkKeys(fresh);
  }
  await checkSizes(stems, running);
  const dark = await open({ colorScheme: 'dark', viewport: { width: 820, height: 900 } }, running ? `#${running}~metrics` : '');
  if (running) await opened(dark, running);
  check(await dark.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth), 'the page is wider than a narrow window');
  const plain = await open({ javaScriptEnabled: false });
  check((await plain.locator('.page:visible').count()) === 4, 'without scripts not all sections show');
  check((await plain.locator('#cases tbody tr:visible').count()) === stems.length, 'without scripts not all scenarios stand in the table');
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
