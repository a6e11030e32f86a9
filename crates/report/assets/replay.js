// The replay of one scenario: time, which run, camera, and the controls that move them.

const MODES = ['before', 'untuned', 'toldTuned', 'after', 'both', 'reference'];
/** How long before the encounter a replay opens. [s] */
const LEAD_S = 1.5;
/** Kinds of events, the gravest first: what a mark for several of them looks like. */
const GRAVITY = ['contact', 'obstacle', 'gap', 'handover', 'braking', 'finding', 'end'];

class Replay {
  constructor(section) {
    this.section = section;
    this.kase = readCase(section.dataset.case);
    this.root = one('.replay', section);
    this.views = one('.views', section);
    this.scrub = one('.scrub', section);
    this.clock = one('.clock', section);
    this.marks = one('.marks', section);
    this.time = 0;
    this.rate = 1;
    this.loop = false;
    this.camera = 'fit';
    this.zoom = 1;
    this.pan = [0, 0];
    this.playing = false;
    this.plots = all('.plot', section).map((figure) => new Plot(figure, this.kase, (time) => this.seek(time)));
    this.bounds = boundsOf(this.kase.drawing.surfaces.flat());
    this.bind();
    this.show(this.kase.after ? 'after' : 'before');
    this.seek((encounterOf(this.told[1])?.time ?? 0) - LEAD_S);
    new ResizeObserver(() => this.draw()).observe(this.views);
  }

  bind() {
    all('[data-mode]', this.root).forEach((button) => button.addEventListener('click', () => this.show(button.dataset.mode)));
    all('[data-camera]', this.root).forEach((button) => button.addEventListener('click', () => this.look(button.dataset.camera)));
    all('button[data-act]', this.root).forEach((button) => button.addEventListener('click', () => this.act(button.dataset.act)));
    one('select[data-act=rate]', this.root).addEventListener('change', (event) => {
      this.rate = Number(event.target.value);
    });
    this.scrub.addEventListener('input', () => this.seek(Number(this.scrub.value)));
    this.views.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoomBy(event.deltaY < 0 ? 1.12 : 1 / 1.12);
    }, { passive: false });
    this.views.addEventListener('pointerdown', (event) => this.views.setPointerCapture(event.pointerId));
    this.views.addEventListener('pointermove', (event) => {
      if (!(event.buttons & 1) || !this.lastCamera) return;
      this.pan[0] -= event.movementX / this.lastCamera.scale;
      this.pan[1] += event.movementY / this.lastCamera.scale;
      this.draw();
    });
    this.views.addEventListener('dblclick', () => this.act('reset'));
  }

  get runs() {
    return this.shownIn(this.mode).map((which) => [which, this.kase[which]]).filter(([, run]) => run);
  }

  /** The runs that a mode shows; the reference driver beside the ego's last run. */
  shownIn(mode) {
    if (mode === 'both') return ['before', 'after'];
    return mode === 'reference' ? [this.kase.after ? 'after' : 'before', 'reference'] : [mode];
  }

  get end() {
    return Math.max(...this.runs.map(([, run]) => run.end), 0);
  }

  /** The run whose numbers are told, which is one of the plots: the tuned one where both are seen. */
  get told() {
    const plotted = this.runs.filter(([which]) => which !== 'reference');
    return plotted[plotted.length - 1];
  }

  show(mode) {
    if (!this.shownIn(mode).every((which) => this.kase[which])) return;
    this.mode = mode;
    all('[data-mode]', this.root).forEach((button) => button.setAttribute('aria-pressed', button.dataset.mode === mode));
    all('.view', this.views).forEach((view) => {
      view.hidden = !this.runs.some(([which]) => which === view.dataset.run);
    });
    this.scrub.max = this.end;
    this.scrub.step = this.runs[0][1].step;
    this.mark();
    this.seek(Math.min(this.time, this.end));
  }

  /** Marks on the slider: the events of the run that is told, those that fall together as one. */
  mark() {
    const groups = [];
    for (const event of this.told[1].events) {
      const last = groups[groups.length - 1];
      if (last && event.time - last[0].time < 0.012 * this.end + 0.051) last.push(event);
      else groups.push([event]);
    }
    this.moments = groups.map((events) => {
      const grave = [...events].sort((a, b) => GRAVITY.indexOf(a.kind) - GRAVITY.indexOf(b.kind))[0];
      return { time: grave.time, kind: grave.kind, text: events.map((event) => event.text).join('; ') };
    });
    this.marks.replaceChildren(...this.moments.map(({ time, kind, text }) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.className = `event ${kind}`;
      button.title = `${fixed(time, 1)} s: ${text}`;
      button.setAttribute('aria-label', button.title);
      button.style.left = `${(100 * clamp(time, 0, this.end)) / (this.end || 1)}%`;
      button.addEventListener('click', () => this.toMoment({ time, text }));
      return button;
    }));
  }

  toMoment(moment) {
    if (!moment) return;
    this.pause();
    this.seek(moment.time);
    tell(`${fixed(moment.time, 1)} seconds: ${moment.text}`);
  }

  look(camera) {
    this.camera = camera;
    this.zoom = 1;
    this.pan = [0, 0];
    all('[data-camera]', this.root).forEach((button) => button.setAttribute('aria-pressed', button.dataset.camera === camera));
    this.draw();
  }

  zoomBy(factor) {
    this.zoom = clamp(this.zoom * factor, 0.2, 12);
    this.draw();
  }

  seek(time) {
    this.time = clamp(time, 0, this.end);
    this.draw();
  }

  step(seconds) {
    this.pause();
    const step = this.runs[0][1].step;
    this.seek(Math.round((this.time + seconds) / step) * step);
  }

  act(name) {
    const closest = this.told[1].minGap;
    const acts = {
      play: () => (this.playing ? this.pause() : this.play()),
      start: () => this.seek(0),
      end: () => this.seek(this.end),
      back: () => this.step(-0.1),
      on: () => this.step(0.1),
      'back-far': () => this.step(-1),
      'on-far': () => this.step(1),
      'event-back': () => this.toMoment(this.moments.filter(({ time }) => time < this.time - 0.01).pop()),
      'event-on': () => this.toMoment(this.moments.find(({ time }) => time > this.time + 0.01)),
      closest: () => closest && (this.pause(), this.seek(closest.time)),
      loop: () => {
        this.loop = !this.loop;
        one('[data-act=loop]', this.root).setAttribute('aria-pressed', this.loop);
      },
      'zoom-in': () => this.zoomBy(1.25),
      'zoom-out': () => this.zoomBy(0.8),
      reset: () => this.look(this.camera),
      follow: () => this.look(this.camera === 'follow' ? 'fit' : 'follow'),
      mode: () => {
        const modes = MODES.filter((mode) => one(`[data-mode=${mode}]`, this.root)?.disabled === false);
        this.show(modes[(modes.indexOf(this.mode) + 1) % modes.length]);
      },
    };
    acts[name]?.();
  }

  play() {
    if (this.time >= this.end - 1e-6) this.time = 0;
    this.playing = true;
    this.root.classList.add('playing');
    one('.play', this.root).setAttribute('aria-label', 'Pause');
    let last = null;
    const frameOn = (now) => {
      if (!this.playing) return;
      // A tab that was hidden must not jump.
      if (last !== null) this.time += (Math.min(now - last, 100) / 1000) * this.rate;
      last = now;
      if (this.time >= this.end) {
        if (this.loop) this.time = 0;
        else {
          this.time = this.end;
          this.pause();
        }
      }
      this.draw();
      if (this.playing) requestAnimationFrame(frameOn);
    };
    requestAnimationFrame(frameOn);
  }

  pause() {
    this.playing = false;
    this.root.classList.remove('playing');
    one('.play', this.root).setAttribute('aria-label', 'Play');
  }

  cameraFor(width, height) {
    let camera;
    if (this.camera === 'map') camera = frame(this.bounds, width, height, 2, [10, 10], 0.3, 20);
    else if (this.camera === 'follow') camera = { x: 0, y: 0, scale: clamp(height / 46, 4, 12), follow: true };
    else camera = frame(boundsOf(this.runs.flatMap(([, run]) => interesting(run, Math.min(this.time, run.end)))), width, height, 4, [Math.min(80, width / 6), 44], 1, 13);
    camera.scale *= this.zoom;
    camera.x += this.pan[0];
    camera.y += this.pan[1];
    return camera;
  }

  draw() {
    for (const view of all('.view:not([hidden])', this.views)) {
      const canvas = one('canvas', view);
      if (!canvas.clientWidth) return;
      const run = this.kase[view.dataset.run];
      const camera = this.cameraFor(canvas.clientWidth, canvas.clientHeight);
      if (camera.follow) {
        const ego = stateAt(run.actors[0], run, this.time);
        camera.x += ego.x;
        camera.y += ego.y;
      }
      this.lastCamera = camera;
      const ghost = this.ghosts ? this.kase[view.dataset.run === 'before' ? 'after' : 'before'] : undefined;
      drawScene(canvas, this.kase, run, Math.min(this.time, run.end), camera, ghost);
    }
    this.scrub.value = this.time;
    this.scrub.setAttribute('aria-valuetext', `${fixed(this.time, 1)} seconds`);
    this.clock.textContent = `${fixed(this.time, 1)} / ${fixed(this.end, 1)} s`;
    this.plots.forEach((plot) => plot.at(this.time, this.told[0]));
  }
}

const KEYS = {
  ' ': 'play', ArrowLeft: 'back', ArrowRight: 'on', Home: 'start', End: 'end', m: 'closest', b: 'mode', f: 'follow',
  ',': 'event-back', '.': 'event-on', l: 'loop', '+': 'zoom-in', '=': 'zoom-in', '-': 'zoom-out', 0: 'reset',
};

/** What a key does to the replay; whether it did something. */
function replayKey(replay, event) {
  const act = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return false;
  replay.act(event.shiftKey && (act === 'back' || act === 'on') ? `${act}-far` : act);
  return true;
}
