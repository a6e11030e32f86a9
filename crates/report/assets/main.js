// Which section is seen, keys that work everywhere, copying.

const replays = new Map();
let currentPage = one('.page.current');
let overviewScroll = 0;

const replayOf = (section) => {
  if (!one('.stage', section)) return null;
  const { before, after } = readCase(section.dataset.case);
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

/** What the address names: the place, and the tab where there is one. */
function address() {
  try {
    return decodeURIComponent(location.hash.slice(1)).split('~');
  } catch {
    return [''];
  }
}

/** Draws a scenario that is seen and whose file has come. */
function enter(section) {
  if (section !== currentPage || !('filled' in section.dataset)) return;
  const replay = replayOf(section);
  if (replay) {
    replay.plots.forEach((plot) => plot.draw());
    replay.draw();
  }
  chooseTab(section, chosenTab);
  tell(one('h1', section).textContent);
}

function go() {
  const [id, tab] = address();
  const isCase = positions.has(id);
  const page = isCase ? caseSection(id, enter) : document.getElementById(id)?.closest('.page') ?? one('#overview');
  if (tab) chosenTab = tab;
  const isNew = page !== currentPage;
  if (isNew) {
    if (currentPage.id === 'overview') overviewScroll = scrollY;
    replays.get(currentPage)?.pause();
    currentPage.classList.remove('current');
    page.classList.add('current');
    currentPage = page;
  }
  all('.top nav a').forEach((link) => {
    if (link.hash === `#${page.id}`) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  });
  const at = isCase ? listed.indexOf(positions.get(id)) : -1;
  one('#case-place').textContent = at < 0 ? '' : `${at + 1} of ${listed.length}`;
  one('#case-previous').disabled = listed.length === 0 || at === 0;
  one('#case-next').disabled = listed.length === 0 || at === listed.length - 1;
  if (isCase) {
    makeRoom(page, (section) => replays.delete(section));
    enter(page);
  }
  if (isNew) {
    scrollTo(0, page.id === 'overview' ? overviewScroll : 0);
    if (!isCase) tell(one('h1', page).textContent);
  }
}

function goToCase(step) {
  const at = currentPage.classList.contains('case') ? listed.indexOf(positions.get(currentPage.id)) : -1;
  const next = listed[at < 0 ? (step > 0 ? 0 : listed.length - 1) : at + step];
  if (next !== undefined) location.hash = `case-${stems[next]}`;
}

function find() {
  location.hash = 'overview';
  go();
  one('#case-search')?.focus();
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
    '/': find,
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
  const replay = replays.get(currentPage);
  if (replay && replayKey(replay, event)) event.preventDefault();
}

readColours();
nameCells(document);
setUpTable();
setUpMap();
setUpFacts();
addEventListener('click', (event) => {
  const button = event.target.closest?.('[data-copy]');
  if (button) copy(button);
});
one('#help-open').addEventListener('click', () => one('#help').showModal());
one('#case-find').addEventListener('click', find);
one('#case-previous').addEventListener('click', () => goToCase(-1));
one('#case-next').addEventListener('click', () => goToCase(1));
addEventListener('hashchange', go);
addEventListener('keydown', onKey);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  readColours();
  replays.forEach((replay) => replay.draw());
});
addEventListener('beforeprint', () => {
  all('.page.current details').forEach((details) => (details.open = true));
  replays.get(currentPage)?.act('closest');
});
addEventListener('resize', () => 'filled' in currentPage.dataset && chooseTab(currentPage, chosenTab));
go();
