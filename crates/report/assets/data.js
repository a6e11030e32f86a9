// Data and small helpers. Columns hold whole numbers as differences; see src/data.rs.

const one = (selector, root = document) => root.querySelector(selector);
const all = (selector, root = document) => [...root.querySelectorAll(selector)];

/** An SVG element with attributes, and text where there is some. */
function svg(name, attributes = {}, text) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

/** Names every cell of tables with a head, for windows too narrow for columns. */
function nameCells(root) {
  for (const table of all('table.plain:has(thead)', root)) {
    const names = all('thead tr > *', table).map((head) => head.textContent);
    table.classList.add('folds');
    for (const row of all('tbody tr', table)) {
      [...row.cells].forEach((cell, i) => {
        if (names[i] && cell.tagName === 'TD') cell.dataset.label = names[i];
      });
    }
  }
}

const readBlock = (id) => JSON.parse(document.getElementById(id).textContent);
const suite = readBlock('suite-data');

/** Sums differences up; null becomes not-a-number. */
function running(differences, scale) {
  const values = new Float64Array(differences.length);
  let sum = 0;
  differences.forEach((difference, i) => {
    if (difference === null) values[i] = NaN;
    else values[i] = (sum += difference) / scale;
  });
  return values;
}

const polyline = ([xs, ys]) => {
  const [x, y] = [running(xs, 100), running(ys, 100)];
  return Array.from(x, (value, i) => [value, y[i]]);
};

function readRun(raw) {
  if (!raw || !raw.actors.length || !raw.actors[0].x.length) return null;
  const actors = raw.actors.map((actor) => ({
    ...actor,
    x: running(actor.x, 1000),
    y: running(actor.y, 1000),
    heading: running(actor.heading, 10000),
    speed: running(actor.speed, 1000),
    throttle: running(actor.throttle, 20),
  }));
  const gaps = raw.gaps.map(([actor, values]) => ({ actor, values: running(values, 1000) }));
  const steps = actors.length ? actors[0].x.length : 0;
  return {
    step: raw.step,
    steps,
    end: Math.round(Math.max(0, steps - 1) * raw.step * 1e6) / 1e6,
    why: raw.why,
    actors,
    obstacles: raw.obstacles.map(([kind, x, y, heading, length, width]) => ({ kind, x, y, heading, length, width })),
    contacts: raw.contacts.map(([time, x, y, actor]) => ({ time, x, y, actor })),
    gaps,
    partner: gaps.find(({ actor }) => actor === raw.partner) ?? gaps[0] ?? null,
    signals: (raw.signals ?? []).map(([line, device]) => ({ line, device })),
    stops: raw.stops ?? [],
    handover: raw.handover ?? null,
    accelerations: raw.accelerations.map(([actor, values]) => ({ actor, values: running(values, 100) })),
    minGap: raw.minGap ? { value: raw.minGap[0], time: raw.minGap[1] } : null,
    events: raw.events.map(([time, kind, text]) => ({ time, kind, text })),
  };
}

const cases = new Map();

/** A case by its name, read on first use; `rawCase` knows where it stands. */
function readCase(name) {
  if (!cases.has(name)) {
    const raw = rawCase(name);
    const drawing = {
      surfaces: raw.surfaces.map(polyline),
      areas: raw.areas.map(([shape, points]) => ({ shape, points: polyline(points) })),
      lines: raw.lines.map(([kind, points]) => ({ kind, points: polyline(points) })),
    };
    cases.set(name, { id: raw.id, drawing, before: readRun(raw.before), untuned: readRun(raw.untuned), toldTuned: readRun(raw.toldTuned), after: readRun(raw.after), reference: readRun(raw.reference), tune: raw.tune });
  }
  return cases.get(name);
}

/** A value of a column between two steps. */
function valueAt(values, run, time) {
  if (!values.length) return NaN;
  const place = Math.min(Math.max(time / run.step, 0), values.length - 1);
  const i = Math.min(Math.floor(place), values.length - 2);
  if (i < 0) return values[0];
  const part = place - i;
  // A value at a step stands by itself, even beside one that is not defined.
  if (part < 1e-6) return values[i];
  if (part > 1 - 1e-6) return values[i + 1];
  return values[i] + (values[i + 1] - values[i]) * part;
}

/** Whether an actor is in the world. */
const isThere = (actor, time) => time >= (actor.from ?? 0) - 1e-9 && time < (actor.until ?? Infinity) - 1e-9;

/** What a signal shows; `stop` or `yield` of a sign. */
function aspectAt(device, time) {
  if (typeof device === 'string') return device;
  const [phases, offset] = device;
  const cycle = phases.reduce((sum, [, length]) => sum + length, 0);
  let left = (((time + offset) % cycle) + cycle) % cycle;
  for (const [aspect, length] of phases) {
    if (left < length) return aspect;
    left -= length;
  }
  return phases[phases.length - 1][0];
}

/** State of an actor between two steps; headings go the short way round. */
function stateAt(actor, run, time) {
  const place = Math.min(Math.max(time / run.step, 0), actor.x.length - 1);
  const i = Math.max(0, Math.min(Math.floor(place), actor.x.length - 2));
  const j = Math.min(i + 1, actor.x.length - 1);
  const part = place - i;
  const turn = Math.atan2(Math.sin(actor.heading[j] - actor.heading[i]), Math.cos(actor.heading[j] - actor.heading[i]));
  return {
    x: actor.x[i] + (actor.x[j] - actor.x[i]) * part,
    y: actor.y[i] + (actor.y[j] - actor.y[i]) * part,
    heading: actor.heading[i] + turn * part,
    speed: actor.speed[i] + (actor.speed[j] - actor.speed[i]) * part,
    braking: actor.throttle[i] < -0.049,
  };
}

const fixed = (value, decimals) => (Number.isFinite(value) ? value.toFixed(decimals).replace(/^-(0\.?0*)$/, '$1') : '\u2013');
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** Tells a screen reader. */
function tell(text) {
  one('#live').textContent = text;
}
