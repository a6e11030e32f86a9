// A fact lights its words, or its columns in the record it names; words light their facts.

function setUpFacts() {
  const light = (story, numbers, columns, record) => {
    const on = (element, yes) => element.classList.toggle('on', yes);
    all('mark', story).forEach((mark) => on(mark, mark.dataset.facts.split(' ').some((number) => numbers.includes(number))));
    all('.facts tr[data-fact]', story).forEach((row) => on(row, numbers.includes(row.dataset.fact)));
    const fits = (row) => columns.some((column) => row.dataset.columns.includes(column) || column.includes(row.dataset.columns));
    all('tr[data-columns]', story).forEach((row) => on(row, row.closest('.record').dataset.record === record && fits(row)));
  };
  const look = (event) => {
    const story = event.target.closest?.('.story');
    if (!story) return;
    const row = event.target.closest('tr[data-fact]');
    const mark = event.target.closest('mark');
    if (row) light(story, [row.dataset.fact], row.dataset.column ? [row.dataset.column] : [], row.dataset.record);
    else if (mark) light(story, mark.dataset.facts.split(' '), []);
    else light(story, [], []);
    if (row && event.type === 'focusin') one('mark.on, .record tr.on', story)?.scrollIntoView({ block: 'nearest' });
  };
  one('#main').addEventListener('pointerover', look);
  one('#main').addEventListener('focusin', look);
}
