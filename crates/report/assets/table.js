// The table of scenarios: sorting, searching, showing only some. Its rows are drawn in slices: a few at first, more when
// they are about to come into sight.

const SLICE = 60;
/** Scenarios that the table lists, by their positions in the suite, in the table's order. */
let listed = stems.map((_, position) => position);

/** Values to sort by, one a scenario; null where there is none. */
function sortKeys(key) {
  const column = suite.rows[key];
  if (!column) return stems.map((_, position) => position);
  if (!['operator', 'city', 'kind'].includes(key)) return column;
  const [names, of] = column;
  const places = new Map([...names].sort((a, b) => a.localeCompare(b, 'en')).map((name, place) => [name, place]));
  return of.map((index) => (index === null ? null : places.get(names[index])));
}

function setUpTable() {
  const table = one('#cases');
  if (!table) return;
  const body = one('tbody', table);
  const rows = all('tr', body);
  const [search, tag, sort, direction, more] = ['search', 'filter', 'sort', 'direction', 'more'].map((name) => one(`#case-${name}`));
  const only = all('[data-only]');
  let drawn = 0;
  let texts = null;

  const draw = (upto) => {
    body.append(...listed.slice(drawn, upto).map((position) => rows[position]));
    drawn = Math.min(upto, listed.length);
    more.hidden = drawn >= listed.length;
    more.textContent = `${drawn} of ${listed.length} scenarios are drawn; more follow.`;
  };
  new IntersectionObserver((entries, observer) => {
    if (!entries[entries.length - 1].isIntersecting) return;
    draw(drawn + SLICE);
    // Asked anew: it may still be in sight.
    observer.unobserve(more);
    observer.observe(more);
  }, { rootMargin: '1200px' }).observe(more);

  const list = () => {
    const wanted = search.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    if (wanted.length) texts ??= rows.map((row, position) => `${row.textContent} ${suite.rows.words[position]}`.toLowerCase());
    const chosen = only.filter((select) => select.value !== '').map((select) => [suite.rows[select.dataset.only][1], Number(select.value)]);
    const fits = (position) => (tag.value === 'all' || suite.rows.tags[position].split(' ').includes(tag.value))
      && chosen.every(([of, index]) => of[position] === index)
      && wanted.every((word) => texts[position].includes(word));
    const keys = sortKeys(sort.value);
    const down = direction.getAttribute('aria-pressed') === 'true' ? -1 : 1;
    const compare = (a, b) => {
      // What has no value stands last either way.
      if (keys[a] === null || keys[b] === null) return (keys[a] === null) - (keys[b] === null) || a - b;
      return down * (keys[a] - keys[b]) || a - b;
    };
    listed = stems.map((_, position) => position).filter(fits).sort(compare);
    all('.sort', table).forEach((button) => {
      const head = button.closest('th');
      if (button.dataset.sort === sort.value) head.setAttribute('aria-sort', down > 0 ? 'ascending' : 'descending');
      else head.removeAttribute('aria-sort');
    });
    body.replaceChildren();
    drawn = 0;
    draw(SLICE);
    const all_shown = listed.length === rows.length;
    one('#case-count').textContent = all_shown ? `${rows.length} scenarios` : `${listed.length} of ${rows.length} scenarios`;
    one('#case-reset').hidden = all_shown;
    one('#case-none').hidden = listed.length > 0;
    table.hidden = listed.length === 0;
  };

  for (const select of only) {
    const [names, of] = suite.rows[select.dataset.only];
    const counts = names.map((name, index) => [name, index, of.filter((value) => value === index).length]);
    for (const [name, index, count] of counts.sort((a, b) => a[0].localeCompare(b[0], 'en'))) select.append(new Option(`${name} (${count})`, index));
    select.closest('label').hidden = names.length < 2;
    select.addEventListener('change', list);
  }
  // Of these the most is looked for first.
  const mostFirst = new Set(['severity', 'harm', 'impact', 'findings']);
  all('.sort', table).forEach((button) => button.addEventListener('click', () => {
    const again = sort.value === button.dataset.sort;
    sort.value = button.dataset.sort;
    direction.setAttribute('aria-pressed', again ? direction.getAttribute('aria-pressed') !== 'true' : mostFirst.has(sort.value));
    list();
  }));
  direction.addEventListener('click', () => {
    direction.setAttribute('aria-pressed', direction.getAttribute('aria-pressed') !== 'true');
    list();
  });
  search.addEventListener('input', list);
  tag.addEventListener('change', list);
  sort.addEventListener('change', () => {
    direction.setAttribute('aria-pressed', mostFirst.has(sort.value));
    list();
  });
  one('#case-reset').addEventListener('click', () => {
    search.value = '';
    tag.value = 'all';
    only.forEach((select) => (select.value = ''));
    list();
    search.focus();
  });
  // The whole row leads to its scenario; the link in it is what keyboards and screen readers use.
  body.addEventListener('click', (event) => {
    if (event.target.closest('a, button') || String(getSelection())) return;
    const link = event.target.closest('tr')?.querySelector('.case-link');
    if (link) location.hash = link.hash;
  });
  addEventListener('beforeprint', () => draw(listed.length));
  list();
  table.classList.add('ready');
}
