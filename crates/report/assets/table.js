// The table of scenarios: sorting by its head, searching, and showing only some.

function setUpTable() {
  const table = one('#cases');
  if (!table) return;
  const body = one('tbody', table);
  const rows = all('tr', body);
  const search = one('#case-search');
  const texts = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));

  const sort = (column, ascending) => {
    const keys = new Map(rows.map((row) => [row, row.cells[column].dataset.sort ?? '']));
    const numeric = rows.every((row) => keys.get(row) === '' || !Number.isNaN(Number(keys.get(row))));
    const compare = (a, b) => {
      const [x, y] = [keys.get(a), keys.get(b)];
      // What has no value stands last either way.
      if (x === '' || y === '') return (x === '') - (y === '');
      const order = numeric ? Number(x) - Number(y) : x.localeCompare(y, 'en');
      return ascending ? order : -order;
    };
    body.append(...[...rows].sort((a, b) => compare(a, b) || rows.indexOf(a) - rows.indexOf(b)));
  };
  all('.sort', table).forEach((button) => {
    const head = button.closest('th');
    button.addEventListener('click', () => {
      const ascending = head.getAttribute('aria-sort') !== 'ascending';
      all('th[aria-sort]', table).forEach((other) => other.removeAttribute('aria-sort'));
      head.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
      sort(head.cellIndex, ascending);
    });
  });

  const filter = () => {
    const wanted = search.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const tag = one('input[name=case-filter]:checked').value;
    let shown = 0;
    for (const row of rows) {
      const fits = tag === 'all' || row.dataset.tags.split(' ').includes(tag);
      row.hidden = !(fits && wanted.every((word) => texts.get(row).includes(word)));
      shown += !row.hidden;
    }
    one('#case-count').textContent = shown === rows.length ? `${rows.length} scenarios` : `${shown} of ${rows.length} scenarios`;
    one('#case-none').hidden = shown > 0;
    table.parentElement.hidden = shown === 0;
  };
  search.addEventListener('input', filter);
  all('input[name=case-filter]').forEach((input) => input.addEventListener('change', filter));
  one('#case-reset').addEventListener('click', () => {
    search.value = '';
    one('input[name=case-filter][value=all]').checked = true;
    filter();
    search.focus();
  });
  // The whole row leads to its scenario; the link in it is what keyboards and screen readers use.
  body.addEventListener('click', (event) => {
    if (event.target.closest('a, button') || String(getSelection())) return;
    const link = event.target.closest('tr')?.querySelector('.case-link');
    if (link) location.hash = link.hash;
  });
  filter();
}
