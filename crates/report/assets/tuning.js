// The search over a scenario's numbers: objective by point, with the best so far and the point that was kept.

/** Objectives above this are of points that could not be run, or in which nobody came nearer: they stand at the upper edge, and stretch no axis. [m] */
const SCORED_M = 900;

function drawTuning(section) {
  const plot = one('.tune-plot', section);
  if (!plot || !plot.clientWidth) return;
  const log = readCase(section.dataset.case).tune;
  if (!log || !log.points.length) return;
  const points = log.points.map(([objective, gap, failed, by, refused, values], number) => ({ number, objective, gap, failed, by: log.by[by], refused: refused.map((i) => log.reasons[i]), values }));
  const [width, height] = [plot.clientWidth, plot.clientHeight];
  const margin = { left: 40, right: 10, top: 8, bottom: 20 };
  const drawn = points.filter((point) => point.objective !== null);
  const [low, high] = drawn.filter(({ objective }) => objective < SCORED_M).reduce(([a, b], { objective }) => [Math.min(a, objective), Math.max(b, objective)], [0, 1]);
  const x = (number) => margin.left + ((number + 0.5) / points.length) * (width - margin.left - margin.right);
  const y = (value) => height - margin.bottom - ((clamp(value, low, high) - low) / (high - low || 1)) * (height - margin.top - margin.bottom) * 0.96;
  const parts = [svg('rect', { class: 'plot-frame', x: margin.left, y: margin.top, width: width - margin.left - margin.right, height: height - margin.top - margin.bottom })];
  for (const value of ticks(low, high, 5)) {
    parts.push(svg('line', { class: 'plot-grid', x1: margin.left, x2: width - margin.right, y1: y(value), y2: y(value) }));
    parts.push(svg('text', { class: 'plot-text', x: margin.left - 6, y: y(value) + 4, 'text-anchor': 'end' }, Number(value.toFixed(6))));
  }
  for (const value of ticks(0, points.length - 1, 8).filter(Number.isInteger)) {
    parts.push(svg('text', { class: 'plot-text', x: x(value), y: height - 5, 'text-anchor': 'middle' }, value));
  }
  // A failure is better than all that pass, as in the search.
  let best = null;
  let path = '';
  for (const { number, objective, failed, refused } of points) {
    const better = !best || failed > best.failed || (failed === best.failed && objective < best.objective);
    if (objective !== null && !refused.length && better) {
      path += path ? `H${x(number)}V${y(objective)}` : `M${x(number)} ${y(objective)}`;
      best = { objective, failed };
    }
  }
  if (path) parts.push(svg('path', { class: 'tune-best', d: `${path}H${x(points.length - 1)}` }));
  for (const { number, objective, failed, refused } of drawn) {
    const at = `translate(${x(number).toFixed(1)} ${y(objective).toFixed(1)})`;
    if (refused.length) parts.push(svg('path', { class: 'tune-refused', d: 'M-3.5 -3.5L3.5 3.5M3.5 -3.5L-3.5 3.5', transform: at }));
    else if (failed) parts.push(svg('path', { class: 'tune-failed', d: 'M0 -5L5 0L0 5L-5 0z', transform: at }));
    else parts.push(svg('circle', { class: 'tune-point', r: 3.6, transform: at }));
  }
  const kept = points[log.best ?? -1];
  if (kept && kept.objective !== null) parts.push(svg('circle', { class: 'tune-kept', r: 8, cx: x(kept.number), cy: y(kept.objective) }));
  const ring = svg('circle', { class: 'tune-ring', r: 6.5, cx: -50, cy: -50 });
  plot.setAttribute('viewBox', `0 0 ${width} ${height}`);
  plot.replaceChildren(...parts, ring);

  const detail = one('.tune-detail', section);
  let current = -1;
  const show = (number) => {
    const point = points[number];
    if (!point) return;
    current = number;
    if (point.objective !== null) {
      ring.setAttribute('cx', x(number));
      ring.setAttribute('cy', y(point.objective));
    }
    const verdict = point.refused.length ? `refused: ${point.refused.join('; ')}` : point.failed ? 'the ego fails' : 'the ego passes';
    const values = log.parameters.map((name, i) => `${name.split('/').filter(Boolean).join('.')} = ${point.values[i] ?? '\u2013'}`);
    detail.textContent = `Point ${number} (${point.by}): objective ${fixed(point.objective < SCORED_M ? point.objective ?? NaN : NaN, 2)} m, least gap ${fixed(point.gap ?? NaN, 2)} m, ${verdict}. ${values.join(', ')}`;
  };
  plot.onpointermove = (event) => {
    const box = plot.getBoundingClientRect();
    show(clamp(Math.floor(((event.clientX - box.left - margin.left) / (width - margin.left - margin.right)) * points.length), 0, points.length - 1));
  };
  plot.onkeydown = (event) => {
    const to = { ArrowRight: current + 1, ArrowLeft: current - 1, Home: 0, End: points.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    show(clamp(to, 0, points.length - 1));
  };
}
