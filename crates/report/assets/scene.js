// Drawing one moment of one run, seen from above. The world has y up; the picture has y down.

const NAMES = ['ground', 'asphalt', 'paint', 'centre', 'edge', 'guide', 'bike', 'parking', 'shoulder', 'median', 'sidewalk', 'crosswalk', 'driveway',
  'building', 'contact', 'scene-ego', 'scene-partner', 'scene-traffic', 'scene-ink', 'panel', 'ink', 'sans'];
let colours = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

const boundsOf = (points) => points.reduce(
  (box, [x, y]) => [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)],
  [Infinity, Infinity, -Infinity, -Infinity],
);

/** A camera that shows a box of the world with a margin in metres, and one in pixels for labels. */
function frame(box, width, height, margin, [aside, above], least, most) {
  const [w, h] = [box[2] - box[0] + 2 * margin, box[3] - box[1] + 2 * margin];
  const scale = clamp(Math.min((width - 2 * aside) / w, (height - 2 * above) / h), least, most);
  return { x: (box[0] + box[2]) / 2, y: (box[1] + box[3]) / 2, scale };
}

/** Ego and partners now, and where they are nearest: always in the picture, the nearer the larger. */
function interesting(run, time) {
  const points = [];
  const closest = encounterOf(run)?.time ?? run.end;
  for (const actor of run.actors) {
    if (actor.role === 'traffic') continue;
    for (const at of [time, closest]) {
      if (!isThere(actor, at)) continue;
      const state = stateAt(actor, run, at);
      points.push([state.x, state.y]);
    }
  }
  return points;
}

function drawScene(canvas, kase, run, time, camera, ghost) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext('2d');
  const k = camera.scale;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = colours.ground;
  pen.fillRect(0, 0, width, height);
  const toX = (x) => (x - camera.x) * k + width / 2;
  const toY = (y) => (camera.y - y) * k + height / 2;
  const trace = (points) => {
    pen.beginPath();
    points.forEach(([x, y], i) => (i ? pen.lineTo(toX(x), toY(y)) : pen.moveTo(toX(x), toY(y))));
  };
  drawRoad(pen, kase.drawing, trace, k);
  run.signals.forEach((signal) => drawSignal(pen, signal, time, trace, toX, toY, k));
  run.stops.forEach((stop) => drawStop(pen, toX(stop[0]), toY(stop[1]), k));
  run.obstacles.forEach((obstacle) => drawObstacle(pen, obstacle, toX(obstacle.x), toY(obstacle.y), k));
  const order = [...run.actors.keys()].reverse();
  for (const i of order) if (run.actors[i].role !== 'traffic' && isThere(run.actors[i], time)) drawTrail(pen, run, run.actors[i], time, trace, k);
  if (ghost) drawGhost(pen, ghost, Math.min(time, ghost.end), toX, toY, k);
  for (const i of order) if (isThere(run.actors[i], time)) drawActor(pen, run.actors[i], stateAt(run.actors[i], run, time), toX, toY, k);
  run.contacts.filter((contact) => contact.time <= time + 0.051).forEach((contact) => drawContact(pen, toX(contact.x), toY(contact.y), k));
  drawEncounter(pen, run, time, toX, toY, k);
  drawLabels(pen, run, time, toX, toY, k);
  drawScale(pen, k, height);
}

function drawRoad(pen, drawing, trace, k) {
  pen.setLineDash([]);
  pen.lineJoin = 'round';
  // A rim about every area, then the areas over it: what stays is the kerb around all of them.
  pen.strokeStyle = colours.edge;
  pen.lineWidth = clamp(0.3 * k, 1.6, 5) + 1;
  for (const surface of drawing.surfaces) {
    trace(surface);
    pen.closePath();
    pen.stroke();
  }
  pen.fillStyle = colours.asphalt;
  pen.strokeStyle = colours.asphalt;
  pen.lineWidth = 1;
  for (const surface of drawing.surfaces) {
    trace(surface);
    pen.closePath();
    pen.fill();
    // Hides the seams between neighbouring areas.
    pen.stroke();
  }
  for (const area of drawing.areas) {
    pen.fillStyle = colours[area.shape];
    trace(area.points);
    pen.closePath();
    pen.fill();
  }
  const looks = {
    edge: [colours.edge, 0.16, []],
    lane: [colours.paint, 0.14, [3 * k, 4.5 * k]],
    centre: [colours.centre, 0.16, []],
    guide: [colours.guide, 0.05, []],
    stall: [colours.paint, 0.08, []],
    stop: [colours.paint, 0.45, []],
  };
  pen.lineCap = 'butt';
  pen.lineJoin = 'round';
  for (const line of drawing.lines) {
    const [colour, breadth, dashes] = looks[line.kind];
    pen.strokeStyle = colour;
    pen.lineWidth = clamp(breadth * k, 0.7, 3);
    pen.setLineDash(dashes);
    pen.globalAlpha = line.kind === 'guide' ? 0.3 : 1;
    trace(line.points);
    pen.stroke();
  }
  pen.globalAlpha = 1;
  pen.setLineDash([]);
}

const LAMPS = { green: '#2ee06a', yellow: '#ffd000', red: '#ff3b30', 'flashing red': '#ff3b30', dark: '#7d858d', stop: '#d7191c', yield: '#ffffff' };

/** A stop line in the colour of what stands there, and at its end the lamp or the sign. */
function drawSignal(pen, { line, device }, time, trace, toX, toY, k) {
  const aspect = aspectAt(device, time);
  const lit = aspect !== 'flashing red' || time % 1 < 0.5;
  const sign = aspect === 'stop' || aspect === 'yield';
  pen.strokeStyle = LAMPS[aspect];
  pen.lineWidth = clamp(0.5 * k, 2.5, 6);
  pen.globalAlpha = lit ? 1 : 0.35;
  if (!sign) {
    trace(line);
    pen.stroke();
  }
  const [x, y] = [toX(line[line.length - 1][0]), toY(line[line.length - 1][1])];
  const r = clamp(0.7 * k, 5, 9);
  pen.fillStyle = LAMPS[aspect];
  pen.strokeStyle = sign && aspect === 'yield' ? LAMPS.stop : colours['scene-ink'];
  pen.lineWidth = aspect === 'yield' ? 2 : 1.5;
  pen.beginPath();
  const corners = { stop: 8, yield: 3 }[aspect];
  if (corners) for (let i = 0; i < corners; i++) pen.lineTo(x + r * Math.sin(((2 * i + 1) * Math.PI) / corners), y - r * Math.cos(((2 * i + 1) * Math.PI) / corners));
  else pen.arc(x, y, r, 0, 7);
  pen.closePath();
  pen.fill();
  pen.stroke();
  pen.globalAlpha = 1;
}

/** Where the ego's task has it stop. */
function drawStop(pen, x, y, k) {
  const r = clamp(0.9 * k, 6, 14);
  pen.strokeStyle = colours['scene-ego'];
  pen.lineWidth = 2;
  pen.setLineDash([3, 3]);
  pen.strokeRect(x - r, y - r, 2 * r, 2 * r);
  pen.setLineDash([]);
  pill(pen, 'task stop', x, y - r - 13, colours['scene-ego'], colours['scene-ink']);
}

function drawObstacle(pen, obstacle, x, y, k) {
  pen.save();
  pen.translate(x, y);
  pen.rotate(-obstacle.heading);
  pen.lineWidth = 1;
  pen.strokeStyle = colours['scene-ink'];
  if (obstacle.kind === 'barrier') {
    const [l, w] = [Math.max(obstacle.length * k, 3), Math.max(obstacle.width * k, 8)];
    pen.fillStyle = '#f4f4f4';
    pen.fillRect(-l / 2, -w / 2, l, w);
    pen.fillStyle = '#d7301f';
    for (let i = 0; i < 3; i++) pen.fillRect(-l / 2, -w / 2 + (w * (2 * i + 0.5)) / 6, l, w / 6);
    pen.strokeRect(-l / 2, -w / 2, l, w);
  } else {
    pen.rotate(obstacle.heading);
    const r = Math.max((obstacle.length / 2) * k, obstacle.kind === 'cone' ? 3.4 : 5);
    pen.beginPath();
    pen.moveTo(0, -1.35 * r);
    pen.lineTo(1.15 * r, r);
    pen.lineTo(-1.15 * r, r);
    pen.closePath();
    pen.fillStyle = obstacle.kind === 'cone' ? '#ff6a00' : '#ffd400';
    pen.fill();
    pen.stroke();
    if (obstacle.kind === 'cone') {
      pen.fillStyle = '#ffffff';
      pen.fillRect(-0.5 * r, -0.15 * r, r, 0.4 * r);
    }
  }
  pen.restore();
}

const paintOf = (actor) => colours[`scene-${actor.role}`];

function drawTrail(pen, run, actor, time, trace, k) {
  const now = stateAt(actor, run, time);
  const at = clamp(Math.floor(time / run.step + 1e-9), 0, actor.x.length - 1);
  const past = [];
  for (let i = 0; i <= at; i++) if (isThere(actor, i * run.step)) past.push([actor.x[i], actor.y[i]]);
  past.push([now.x, now.y]);
  const future = [[now.x, now.y]];
  for (let i = at + 1; i < actor.x.length; i++) if (isThere(actor, i * run.step)) future.push([actor.x[i], actor.y[i]]);
  pen.strokeStyle = paintOf(actor);
  pen.lineCap = 'round';
  pen.globalAlpha = 0.75;
  pen.lineWidth = clamp(0.28 * k, 1.2, 3.5);
  trace(past);
  pen.stroke();
  pen.globalAlpha = 0.6;
  pen.lineWidth = clamp(0.2 * k, 1, 2.5);
  pen.setLineDash([1, 5]);
  trace(future);
  pen.stroke();
  pen.setLineDash([]);
  pen.globalAlpha = 1;
}

function drawActor(pen, actor, state, toX, toY, k) {
  // A road user never gets smaller than can be seen.
  const swell = Math.max(1, 9 / (actor.length * k));
  const [l, w] = [actor.length * k * swell, Math.max(actor.width * k * swell, 4)];
  pen.save();
  pen.translate(toX(state.x), toY(state.y));
  pen.rotate(-state.heading);
  pen.fillStyle = paintOf(actor);
  pen.strokeStyle = colours['scene-ink'];
  pen.lineWidth = 1.2;
  pen.beginPath();
  if (actor.shape === 'person') pen.arc(0, 0, Math.max(l, w, 7) / 2, 0, 7);
  else pen.roundRect(-l / 2, -w / 2, l, w, actor.shape === 'truck' ? w * 0.12 : Math.min(w, l) * 0.28);
  pen.fill();
  pen.stroke();
  pen.fillStyle = colours['scene-ink'];
  if (actor.shape === 'person' || actor.shape === 'bike') {
    pen.beginPath();
    pen.arc(0, 0, Math.min(l, w) * 0.3, 0, 7);
    pen.fill();
  } else if (actor.shape !== 'object' && l > 14) {
    const front = actor.shape === 'truck' ? 0.36 : 0.12;
    pen.globalAlpha = 0.6;
    pen.beginPath();
    pen.moveTo(l * (front + 0.1), -w * 0.4);
    pen.lineTo(l * (front + 0.1), w * 0.4);
    pen.lineTo(l * front, w * 0.34);
    pen.lineTo(l * front, -w * 0.34);
    pen.fill();
    if (actor.shape === 'car') pen.fillRect(-l * 0.36, -w * 0.34, l * 0.07, w * 0.68);
    pen.globalAlpha = 1;
  }
  if (actor.shape !== 'person' && actor.shape !== 'object') {
    pen.fillStyle = '#ffffff';
    pen.beginPath();
    pen.moveTo(l / 2 + Math.min(4, w * 0.4), 0);
    pen.lineTo(l / 2 - Math.min(3, w * 0.3), -Math.min(4, w * 0.35));
    pen.lineTo(l / 2 - Math.min(3, w * 0.3), Math.min(4, w * 0.35));
    pen.fill();
  }
  if (state.braking && state.speed > 0.05) {
    pen.fillStyle = '#ff1f1f';
    const size = Math.max(2, w * 0.24);
    pen.fillRect(-l / 2 - 1, -w / 2, Math.max(2, l * 0.06), size);
    pen.fillRect(-l / 2 - 1, w / 2 - size, Math.max(2, l * 0.06), size);
  }
  pen.restore();
}

/** The ego of another run of the same scene, as an outline. */
function drawGhost(pen, run, time, toX, toY, k) {
  const [ego] = run.actors;
  pen.save();
  pen.globalAlpha = 0.4;
  drawActor(pen, ego, stateAt(ego, run, time), toX, toY, k);
  pen.restore();
}

function drawContact(pen, x, y, k) {
  const r = clamp(1.5 * k, 9, 22);
  pen.beginPath();
  for (let i = 0; i < 16; i++) {
    const radius = i % 2 ? r * 0.5 : r;
    const angle = (i * Math.PI) / 8;
    pen.lineTo(x + radius * Math.sin(angle), y - radius * Math.cos(angle));
  }
  pen.closePath();
  pen.fillStyle = colours.contact;
  pen.globalAlpha = 0.8;
  pen.fill();
  pen.globalAlpha = 1;
  pen.strokeStyle = '#b00020';
  pen.lineWidth = 1.6;
  pen.stroke();
}

/** When and where the ego is touched or nearest to another: the moment a replay is about. */
function encounterOf(run) {
  if (run.encounter !== undefined) return run.encounter;
  const event = ['contact', 'obstacle', 'gap'].map((kind) => run.events.find((candidate) => candidate.kind === kind)).find(Boolean);
  run.encounter = event ? { time: event.time, kind: event.kind, at: placeOf(run, event.time) } : null;
  return run.encounter;
}

function placeOf(run, time) {
  const contact = run.contacts.find((candidate) => Math.abs(candidate.time - time) < run.step);
  const ego = stateAt(run.actors[0], run, time);
  if (contact) return [contact.x, contact.y];
  const gap = ({ values }) => valueAt(values, run, time);
  const near = run.gaps.filter((candidate) => run.actors[candidate.actor] && Number.isFinite(gap(candidate))).sort((a, b) => gap(a) - gap(b))[0];
  if (!near) return [ego.x, ego.y];
  const other = run.actors[near.actor];
  const [p, q] = nearestPoints(run.actors[0], ego, other, stateAt(other, run, time));
  return [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
}

/** A ring about the place of the encounter, as long as it lies ahead. */
function drawEncounter(pen, run, time, toX, toY, k) {
  const encounter = encounterOf(run);
  if (!encounter || time > encounter.time - 0.05) return;
  const [x, y] = [toX(encounter.at[0]), toY(encounter.at[1])];
  const r = clamp(2 * k, 12, 30);
  pen.strokeStyle = colours.contact;
  pen.lineWidth = 2;
  pen.setLineDash([5, 4]);
  pen.beginPath();
  pen.arc(x, y, r, 0, 2 * Math.PI);
  pen.stroke();
  pen.setLineDash([]);
  const name = { contact: 'contact', obstacle: 'obstacle contact', gap: 'least gap' }[encounter.kind];
  pill(pen, `${name} in ${fixed(encounter.time - time, 1)} s`, x, y + r + 14, colours.contact, colours['scene-ink']);
}

const corners = (actor, state) => {
  const [c, s] = [Math.cos(state.heading), Math.sin(state.heading)];
  return [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([f, l]) => {
    const [a, b] = [(f * actor.length) / 2, (l * actor.width) / 2];
    return [state.x + c * a - s * b, state.y + s * a + c * b];
  });
};

function nearestOn(actor, state, [x, y]) {
  const [c, s] = [Math.cos(state.heading), Math.sin(state.heading)];
  const [dx, dy] = [x - state.x, y - state.y];
  const along = clamp(dx * c + dy * s, -actor.length / 2, actor.length / 2);
  const across = clamp(dy * c - dx * s, -actor.width / 2, actor.width / 2);
  return [state.x + c * along - s * across, state.y + s * along + c * across];
}

/** Nearest points of two boxes: always at a corner of one of them. Only for drawing; the number comes from the data. */
function nearestPoints(a, stateA, b, stateB) {
  let best = null;
  let least = Infinity;
  const look = (p, q, swap) => {
    const distance = Math.hypot(p[0] - q[0], p[1] - q[1]);
    if (distance < least) [best, least] = [swap ? [q, p] : [p, q], distance];
  };
  for (const corner of corners(a, stateA)) look(corner, nearestOn(b, stateB, corner), false);
  for (const corner of corners(b, stateB)) look(corner, nearestOn(a, stateA, corner), true);
  return best;
}

function pill(pen, text, x, y, fill, ink) {
  pen.font = `600 11px ${colours.sans}`;
  const width = pen.measureText(text).width + 10;
  const canvas = pen.canvas;
  x = clamp(x, width / 2 + 3, canvas.clientWidth - width / 2 - 3);
  y = clamp(y, 12, canvas.clientHeight - 12);
  pen.fillStyle = fill;
  pen.strokeStyle = colours['scene-ink'];
  pen.lineWidth = 1;
  pen.beginPath();
  pen.roundRect(x - width / 2, y - 9, width, 18, 5);
  pen.fill();
  pen.stroke();
  pen.fillStyle = ink;
  pen.textAlign = 'center';
  pen.textBaseline = 'middle';
  pen.fillText(text, x, y + 0.5);
}

function drawLabels(pen, run, time, toX, toY, k) {
  const ego = run.actors[0];
  const egoState = stateAt(ego, run, time);
  const gaps = run.gaps
    .filter(({ actor }) => run.actors[actor] && isThere(run.actors[actor], time))
    .map(({ actor, values }) => ({ actor, gap: valueAt(values, run, time) }))
    .filter(({ gap }) => Number.isFinite(gap));
  const near = gaps.reduce((best, item) => (best && best.gap <= item.gap ? best : item), null);
  const touched = run.contacts.some((contact) => contact.time <= time + 0.051);
  if (near && !touched && near.gap > 0.005 && near.gap < 30) {
    const other = run.actors[near.actor];
    const [p, q] = nearestPoints(ego, egoState, other, stateAt(other, run, time));
    pen.strokeStyle = '#ffffff';
    pen.lineWidth = 1.6;
    pen.setLineDash([4, 3]);
    pen.beginPath();
    pen.moveTo(toX(p[0]), toY(p[1]));
    pen.lineTo(toX(q[0]), toY(q[1]));
    pen.stroke();
    pen.setLineDash([]);
    const fails = near.gap < suite.minGap;
    pill(pen, `${fixed(near.gap, 1)} m`, (toX(p[0]) + toX(q[0])) / 2, (toY(p[1]) + toY(q[1])) / 2, fails ? '#ffd9cc' : '#ffffff', fails ? '#8a1c00' : colours['scene-ink']);
  }
  const partners = run.actors.filter((actor) => actor.role === 'partner' && isThere(actor, time));
  const middle = partners.length ? stateAt(partners[0], run, time) : { x: egoState.x, y: egoState.y - 1 };
  for (const actor of run.actors) {
    if (actor.role === 'traffic' || !isThere(actor, time)) continue;
    const state = stateAt(actor, run, time);
    // Labels point away from the other road user, so that they do not cover the gap.
    const from = actor === ego ? middle : egoState;
    const [dx, dy] = [state.x - from.x, state.y - from.y];
    const length = Math.hypot(dx, dy) || 1;
    const reach = (actor.length * k) / 2 + 24;
    pill(pen, `${actor.id} ${fixed(state.speed, 1)} m/s`, toX(state.x) + (dx / length) * (reach + 18), toY(state.y) - (dy / length) * reach, paintOf(actor), colours['scene-ink']);
  }
}

function drawScale(pen, k, height) {
  const length = [1, 2, 5, 10, 20, 50, 100, 200].find((metres) => metres * k >= 50) ?? 500;
  const [x, y] = [14, height - 14];
  pen.fillStyle = colours.panel;
  pen.globalAlpha = 0.8;
  pen.beginPath();
  pen.roundRect(x - 6, y - 18, length * k + 12, 24, 4);
  pen.fill();
  pen.globalAlpha = 1;
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.5;
  pen.beginPath();
  pen.moveTo(x, y - 4);
  pen.lineTo(x, y);
  pen.lineTo(x + length * k, y);
  pen.lineTo(x + length * k, y - 4);
  pen.stroke();
  pen.fillStyle = colours.ink;
  pen.font = `11px ${colours.sans}`;
  pen.textAlign = 'left';
  pen.textBaseline = 'alphabetic';
  pen.fillText(`${length} m`, x + 4, y - 5);
}
