// Values over time, as SVG, with a cursor that moves with the replay.

const MARGIN = { left: 34, right: 8, top: 4, bottom: 16 };
/** Gaps above this leave the frame: what matters lies below. [m] */
const GAP_SHOWN_M = 20;

/** Round steps for an axis: 1, 2 or 5 times a power of ten. */
function ticks(low, high, about) {
  const rough = (high - low) / about || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough);
  const list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9; i++) list.push(i * step);
  return list;
}

/** Pieces of a line that are defined, as one path. */
function pathOf(values, x, y) {
  let path = '';
  let open = false;
  values.forEach((value, i) => {
    if (Number.isNaN(value)) {
      open = false;
      return;
    }
    path += `${open ? 'L' : 'M'}${x(i).toFixed(1)} ${y(value).toFixed(1)}`;
    open = true;
  });
  return path;
}

/** The lines of one plot: which run, whose, and the values. */
function linesOf(name, kase) {
  const lines = [];
  const single = !(kase.before && kase.after);
  for (const which of ['before', 'untuned', 'toldTuned', 'after']) {
    const run = kase[which];
    if (!run) continue;
    const look = ['before', 'toldTuned'].includes(which) && !single ? 'before' : '';
    const of = run.partner && run.actors[run.partner.actor];
    const who = (actor) => (actor === 0 ? 'ego' : 'partner');
    if (name === 'gap') if (of) lines.push({ which, look, run, who: 'gap', id: of.id, values: run.partner.values.map((value, i) => (isThere(of, i * run.step) ? value : NaN)) });
    if (name === 'speed') {
      run.actors.forEach((actor, i) => {
        if (actor.role !== 'traffic') lines.push({ which, look, run, who: who(i), id: actor.id, values: actor.speed });
      });
    }
    if (name === 'acceleration') {
      for (const { actor, values } of run.accelerations) {
        lines.push({ which, look, run, who: who(actor), id: run.actors[actor]?.id ?? '', values });
      }
    }
  }
  return lines;
}

function rangeOf(name, lines) {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of lines) {
    for (const value of values) if (!Number.isNaN(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  }
  if (name === 'gap') return [0, clamp(high, 2 * suite.minGap, GAP_SHOWN_M)];
  if (name === 'speed') return [Math.min(0, low), Math.max(high * 1.06, 2)];
  return [Math.min(low - 0.4, -1.25 * suite.hardBraking), Math.max(high + 0.4, 2)];
}

class Plot {
  constructor(figure, kase, onTime) {
    this.name = figure.dataset.plot;
    this.svg = one('svg', figure);
    this.readout = one('.readout', figure);
    this.lines = linesOf(this.name, kase);
    this.kase = kase;
    this.end = Math.max(...this.lines.map((line) => line.run.end), 0.1);
    this.time = 0;
    this.shown = 'after';
    const pick = (event) => {
      const box = this.svg.getBoundingClientRect();
      onTime(clamp(((event.clientX - box.left - MARGIN.left) / (box.width - MARGIN.left - MARGIN.right)) * this.end, 0, this.end));
    };
    this.svg.addEventListener('pointerdown', (event) => {
      this.svg.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.svg.addEventListener('pointermove', (event) => event.buttons & 1 && pick(event));
    new ResizeObserver(() => this.draw()).observe(this.svg);
  }

  draw() {
    const [width, height] = [this.svg.clientWidth, this.svg.clientHeight];
    if (width < 60 || height < 30) return;
    const [low, high] = rangeOf(this.name, this.lines);
    const inner = { w: width - MARGIN.left - MARGIN.right, h: height - MARGIN.top - MARGIN.bottom };
    this.x = (time) => MARGIN.left + (time / this.end) * inner.w;
    this.y = (value) => MARGIN.top + (1 - (clamp(value, low, high) - low) / (high - low)) * inner.h;
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const parts = [svg('rect', { class: 'plot-frame', x: MARGIN.left, y: MARGIN.top, width: inner.w, height: inner.h })];
    for (const value of ticks(low, high, inner.h / 28)) {
      const y = this.y(value);
      parts.push(svg('line', { class: value === 0 ? 'plot-zero' : 'plot-grid', x1: MARGIN.left, x2: width - MARGIN.right, y1: y, y2: y }));
      parts.push(svg('text', { class: 'plot-text', x: MARGIN.left - 5, y: y + 3.5, 'text-anchor': 'end' }, Number(value.toFixed(6))));
    }
    for (const value of ticks(0, this.end, inner.w / 60)) {
      const x = this.x(value);
      parts.push(svg('line', { class: 'plot-grid', x1: x, x2: x, y1: MARGIN.top, y2: MARGIN.top + inner.h }));
      const last = value > 0.94 * this.end;
      const anchor = value === 0 ? 'start' : last ? 'end' : 'middle';
      parts.push(svg('text', { class: 'plot-text', x, y: height - 4, 'text-anchor': anchor }, `${Number(value.toFixed(6))}${value === 0 || last ? ' s' : ''}`));
    }
    const limit = { gap: [suite.minGap, 'failure below'], acceleration: [-suite.hardBraking, 'hard braking'] }[this.name];
    if (limit) {
      const y = this.y(limit[0]);
      parts.push(svg('line', { class: 'plot-limit', x1: MARGIN.left, x2: width - MARGIN.right, y1: y, y2: y }));
    }
    for (const line of this.lines) {
      const inFrame = this.name === 'gap' ? line.values.map((value) => (value > high ? NaN : value)) : line.values;
      parts.push(svg('path', { 'data-which': line.which, class: `plot-line ${line.who} ${line.look}`, d: pathOf(inFrame, (i) => this.x(i * line.run.step), this.y) }));
      // The least of this very gap: the run's may be to somebody else.
      const least = line.values.reduce((best, value, i) => (value < (line.values[best] ?? Infinity) ? i : best), -1);
      if (this.name === 'gap' && least >= 0) {
        parts.push(svg('circle', { 'data-which': line.which, class: 'plot-least', cx: this.x(least * line.run.step), cy: this.y(line.values[least]), r: 4 }));
      }
    }
    const handover = this.lines.map((line) => line.run.handover).find((time) => time !== null);
    if (handover !== undefined) {
      const x = this.x(handover);
      parts.push(svg('line', { class: 'plot-handover', x1: x, x2: x, y1: MARGIN.top, y2: MARGIN.top + inner.h }));
      if (this.name === 'gap') parts.push(svg('text', { class: 'plot-text', x: x + 4, y: MARGIN.top + 11 }, 'handover'));
    }
    if (limit) parts.push(svg('text', { class: 'plot-limit-text', x: MARGIN.left + 5, y: this.y(limit[0]) - 3 }, limit[1]));
    this.cursor = svg('line', { class: 'plot-cursor', y1: MARGIN.top, y2: MARGIN.top + inner.h });
    this.dots = this.lines.map((line) => svg('circle', { class: `plot-dot ${line.who}`, r: 3.6 }));
    this.svg.replaceChildren(...parts, this.cursor, ...this.dots);
    this.at(this.time, this.shown);
  }

  /** Moves the cursor; `shown` is the run whose values are told. */
  at(time, shown) {
    this.time = time;
    this.shown = shown;
    const told = [];
    // The system's run before tuning takes the place of its last one where it is looked at, and so does the recorded driver's after it.
    const drawn = [shown === 'toldTuned' ? shown : 'before', shown === 'untuned' ? shown : 'after'];
    all('[data-which]', this.svg).forEach((mark) => mark.setAttribute('visibility', drawn.includes(mark.dataset.which) ? 'visible' : 'hidden'));
    this.lines.forEach((line, i) => {
      const value = valueAt(line.values, line.run, time);
      const inside = this.name !== 'gap' || value <= GAP_SHOWN_M;
      const there = line.which === shown && Number.isFinite(value) && inside;
      if (this.dots) {
        this.dots[i].setAttribute('visibility', there ? 'visible' : 'hidden');
        if (there) {
          this.dots[i].setAttribute('cx', this.x(Math.min(time, line.run.end)));
          this.dots[i].setAttribute('cy', this.y(value));
        }
      }
      if (line.which === shown) told.push([line.who, line.who === 'gap' ? `to ${line.id} ` : `${line.id} `, fixed(value, line.who === 'gap' ? 2 : 1)]);
    });
    if (this.cursor) {
      this.cursor.setAttribute('x1', this.x(time));
      this.cursor.setAttribute('x2', this.x(time));
    }
    this.readout.replaceChildren(...told.slice(0, 4).map(([who, name, value], i) => {
      const span = document.createElement('span');
      span.className = who;
      span.textContent = `${i ? '  \u00b7  ' : ''}${name}${value}`;
      return span;
    }));
  }
}
