// The map of the records: details of a mark by pointer or arrow keys, and one template at a time by the legend.

function setUpMap() {
  const map = one('#map');
  if (!map) return;
  const detail = one('#map-detail');
  const ring = one('#map-ring');
  const marks = all('.mark', map);
  const places = marks.map((mark) => [Number(mark.getAttribute('x')), Number(mark.getAttribute('y'))]);
  let current = -1;

  const line = (tag, text, className) => {
    const element = document.createElement(tag);
    element.textContent = text;
    if (className) element.className = className;
    return element;
  };
  const show = (index) => {
    if (!suite.map[index]) return;
    current = index;
    const [id, entity, when, place, cluster, words] = suite.map[index];
    const [number, stem] = suite.clusters[cluster];
    const template = one(`.legend [data-template="${marks[index].dataset.template}"] span`)?.textContent ?? 'no template';
    ring.setAttribute('cx', places[index][0]);
    ring.setAttribute('cy', places[index][1]);
    const link = document.createElement('a');
    if (positions.has(`case-${stem}`)) {
      link.href = `#case-${stem}`;
      link.textContent = `scenario ${stem}`;
    }
    const where = line('p', [when, place, entity].filter(Boolean).join(' \u00b7 '), 'muted');
    const what = line('p', `${template}; cluster ${number} `);
    what.append(link);
    detail.replaceChildren(line('b', id, 'mono'), where, what, line('p', words, 'words'));
  };
  map.addEventListener('pointerover', (event) => {
    const mark = event.target.closest('[data-point]');
    if (mark) show(Number(mark.dataset.point));
  });
  map.addEventListener('click', (event) => {
    const pick = event.target.closest('.pick');
    if (pick) {
      show(Number(pick.dataset.point));
      one('a', detail)?.click();
    }
  });
  // The nearest mark in the direction of the arrow; what lies off the axis counts double.
  const towards = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] };
  map.addEventListener('keydown', (event) => {
    if (event.key === 'Enter' && current >= 0) one('a', detail)?.click();
    const direction = towards[event.key];
    if (!direction) return;
    event.preventDefault();
    if (current < 0) return show(0);
    const [x, y] = places[current];
    let best = -1;
    let least = Infinity;
    places.forEach(([px, py], i) => {
      if (marks[i].classList.contains('dim')) return;
      const ahead = (px - x) * direction[0] + (py - y) * direction[1];
      const aside = Math.abs((px - x) * direction[1]) + Math.abs((py - y) * direction[0]);
      if (ahead > 0.05 && ahead + 2 * aside < least) [best, least] = [i, ahead + 2 * aside];
    });
    if (best >= 0) show(best);
  });
  map.addEventListener('focus', () => current < 0 && show(0));

  all('.legend button').forEach((button) => {
    button.addEventListener('click', () => {
      const on = button.getAttribute('aria-pressed') !== 'true';
      all('.legend button').forEach((other) => other.setAttribute('aria-pressed', on && other === button));
      all('[data-point]', map).forEach((mark) => {
        mark.classList.toggle('dim', on && mark.dataset.template !== button.dataset.template);
      });
    });
  });
}
