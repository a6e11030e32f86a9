// Scenarios come from files of their own beside the page, `report/ID.js`, each read when it is looked at. A file holds one
// call of `recrashCase` with one JSON value: scripts can be asked for from a disk, where nothing else can.

/** Sections that stay on the page; the oldest makes room. */
const KEPT = 8;
const { stems } = suite.rows;
const positions = new Map(stems.map((stem, position) => [`case-${stem}`, position]));
const given = new Map();
const waiting = new Map();

Object.defineProperty(window, 'recrashCase', {
  value: ({ stem, data, markup }) => {
    waiting.get(stem)?.({ data, markup });
    waiting.delete(stem);
  },
});

const rawCase = (stem) => given.get(stem);

function loadCase(stem) {
  return new Promise((resolve, reject) => {
    const script = document.createElement('script');
    waiting.set(stem, resolve);
    script.src = `report/${stem}.js`;
    // A file that came and did not call is not the file of this scenario.
    script.onload = script.onerror = () => {
      script.remove();
      if (waiting.delete(stem)) reject(new Error(stem));
    };
    document.head.append(script);
  });
}

/** The section of a scenario, filled as soon as its file has come; then `filled` is told. */
function caseSection(anchor, filled) {
  const known = document.getElementById(anchor);
  if (known) return known;
  const stem = stems[positions.get(anchor)];
  const section = document.createElement('section');
  section.className = 'page case';
  section.id = anchor;
  section.dataset.case = stem;
  section.setAttribute('aria-labelledby', `${anchor}-title`);
  const title = document.createElement('h1');
  title.id = `${anchor}-title`;
  title.textContent = stem;
  const word = document.createElement('p');
  word.className = 'empty';
  word.textContent = 'Loading\u2026';
  section.append(title, word);
  one('#main').append(section);
  loadCase(stem).then(
    ({ data, markup }) => {
      given.set(stem, data);
      // Markup set this way runs nothing that may stand in it.
      section.innerHTML = markup;
      section.dataset.filled = '';
      setUpTabs(section);
      nameCells(section);
      filled(section);
    },
    () => {
      word.className = 'banner bad';
      word.textContent = `The file report/${stem}.js is missing or is not this scenario's. Keep the folder "report" beside this page, or make the report again.`;
      section.dataset.failed = '';
    },
  );
  return section;
}

/** Takes old sections off the page, with all that was read for them. */
function makeRoom(current, forget) {
  const old = all('.page.case').filter((section) => section !== current);
  for (const section of old.slice(0, Math.max(0, old.length + 1 - KEPT))) {
    forget(section);
    given.delete(section.dataset.case);
    cases.delete(section.dataset.case);
    section.remove();
  }
}
