// Which section is seen, keys that work everywhere, copying, facts and their words.

const pages = all('.page');
const caseSections = all('.page.case');
const replays = new Map();
let currentPage = null;

const replayOf = (section) => {
  if (!one('.stage', section)) return null;
  const { before, after } = readCase(Number(section.dataset.case));
  if (!before && !after) return null;
  if (!replays.has(section)) replays.set(section, new Replay(section));
  return replays.get(section);
};

/** Keeps the address in step with the tab, without a new entry in the history. */
function rememberPlace(section) {
  try {
    history.replaceState(null, '', `#${section.id}${chosenTab === 'story' ? '' : `~${chosenTab}`}`);
  } catch {
    // Some browsers refuse this for local files; the page works without.
  }
}

function go() {
  const [id, tab] = decodeURIComponent(location.hash.slice(1)).split('~');
  const target = document.getElementById(id);
  const page = target?.closest('.page') ?? pages[0];
  if (tab) chosenTab = tab;
  const isNew = page !== currentPage;
  if (isNew && currentPage) replays.get(currentPage)?.pause();
  currentPage = page;
  pages.forEach((other) => other.classList.toggle('current', other === page));
  const isCase = page.classList.contains('case');
  all('.top nav a').forEach((link) => {
    if (link.hash === `#${page.id}`) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  });
  one('#case-jump').value = isCase ? page.id : '';
  const at = caseSections.indexOf(page);
  one('#case-previous').disabled = caseSections.length === 0 || at === 0;
  one('#case-next').disabled = caseSections.length === 0 || at === caseSections.length - 1;
  if (isCase) {
    const replay = replayOf(page);
    if (replay) {
      replay.plots.forEach((plot) => plot.draw());
      replay.draw();
    }
    chooseTab(page, chosenTab);
  }
  if (isNew) {
    scrollTo(0, 0);
    tell(one('h1', page).textContent);
  }
}

function goToCase(step) {
  const at = caseSections.indexOf(currentPage);
  const next = caseSections[at < 0 ? (step > 0 ? 0 : -1) : at + step];
  if (next) location.hash = next.id;
}

function setUpFacts() {
  // A fact lights its words, or its columns in the record it names.
  const light = (section, numbers, columns, record) => {
    const on = (element, yes) => element.classList.toggle('on', yes);
    all('mark', section).forEach((mark) => on(mark, mark.dataset.facts.split(' ').some((number) => numbers.includes(number))));
    all('.facts tr[data-fact]', section).forEach((row) => on(row, numbers.includes(row.dataset.fact)));
    const fits = (row) => columns.some((column) => row.dataset.columns.includes(column) || column.includes(row.dataset.columns));
    all('tr[data-columns]', section).forEach((row) => on(row, row.closest('.record').dataset.record === record && fits(row)));
  };
  for (const section of caseSections) {
    const look = (event) => {
      const row = event.target.closest?.('tr[data-fact]');
      const mark = event.target.closest?.('mark');
      if (row) light(section, [row.dataset.fact], row.dataset.column ? [row.dataset.column] : [], row.dataset.record);
      else if (mark) light(section, mark.dataset.facts.split(' '), []);
      else light(section, [], []);
      if (row && event.type === 'focusin') one('mark.on, .record tr.on', section)?.scrollIntoView({ block: 'nearest' });
    };
    const panel = one('.story', section);
    panel?.addEventListener('pointerover', look);
    panel?.addEventListener('focusin', look);
    panel?.addEventListener('pointerleave', () => light(section, [], []));
  }
}

async function copy(button) {
  const text = one('code', button.parentElement).textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = document.createElement('textarea');
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
    button.focus();
  }
  tell('Copied');
  button.classList.add('done');
  setTimeout(() => button.classList.remove('done'), 1200);
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || one('#help').open) return;
  const field = event.target.closest('input:not([type=range]), select, textarea');
  if (field) return;
  const acts = {
    '[': () => goToCase(-1),
    ']': () => goToCase(1),
    '?': () => one('#help').showModal(),
    '/': () => {
      location.hash = 'overview';
      go();
      one('#case-search')?.focus();
    },
  };
  if (acts[event.key]) {
    event.preventDefault();
    acts[event.key]();
    return;
  }
  // Buttons, tabs and links keep their own Space; sliders their own arrows; scrolling text its own keys.
  const own = event.target.closest('button, a, summary, [role=tab], pre, svg[tabindex]');
  if (own && (event.key === ' ' || event.key.startsWith('Arrow') || event.key === 'Home' || event.key === 'End')) return;
  if (event.target.matches('input[type=range]') && (event.key.startsWith('Arrow') || event.key === 'Home' || event.key === 'End')) return;
  const replay = currentPage && replays.get(currentPage);
  if (replay && replayKey(replay, event)) event.preventDefault();
}

document.documentElement.classList.add('js');
readColours();
setUpTable();
setUpMap();
setUpFacts();
caseSections.forEach(setUpTabs);
const drawThumbs = setUpThumbs();
all('[data-copy]').forEach((button) => button.addEventListener('click', () => copy(button)));
one('#help-open').addEventListener('click', () => one('#help').showModal());
one('#case-previous').addEventListener('click', () => goToCase(-1));
one('#case-next').addEventListener('click', () => goToCase(1));
one('#case-jump').addEventListener('change', (event) => {
  if (event.target.value) location.hash = event.target.value;
});
addEventListener('hashchange', go);
addEventListener('keydown', onKey);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  readColours();
  drawThumbs();
  replays.forEach((replay) => replay.draw());
});
addEventListener('beforeprint', () => {
  all('.page.current details').forEach((details) => (details.open = true));
  replays.get(currentPage)?.act('closest');
  drawThumbs();
});
addEventListener('resize', () => currentPage?.classList.contains('case') && chooseTab(currentPage, chosenTab));
go();
