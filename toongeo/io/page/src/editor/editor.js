// The landmark editor: what is selected, how points move, and what is drawn.
import { help, question } from './dialog.js';
import { Files } from './files.js';
import { Gestures } from './gestures.js';
import { listenKeys } from './keys.js';
import { History, moved, state } from './landmarks.js';
import { mirrorMap } from './mirror.js';
import { movement, rounded } from './movement.js';
import { Overlay } from './overlay.js';
import { Panel } from './panel.js';
import { Placing } from './placing.js';
import { Refit } from './refit.js';
import { HELP, TEMPLATE } from './template.js';
import { View } from './view.js';

const TOGGLES = ['box', 'soft', 'both', 'fitted'];
const LINE = 7; // CSS px within which a line is hit
const ZOOM = 1.4;
const SEEN = 6000; // ms that a line of status stays on the picture
let editors = 0;

export class Editor {
  constructor(root, settings, backend) {
    root.innerHTML = TEMPLATE;
    this.parts = Object.fromEntries([...root.querySelectorAll('[data-id]')].map((part) => [part.dataset.id, part]));
    editors += 1;
    this.parts.points.id = `toongeo-points-${editors}`;
    this.settings = settings;
    this.backend = backend;
    this.all = settings.names.map((_, k) => k);
    this.history = new History(state(this.all.map(() => [0, 0])));
    this.selection = new Set();
    this.shownState = null;
    this.near = null;
    this.isPanning = false;
    this.on = Object.fromEntries(TOGGLES.map((name) => [name, false]));
    this.view = new View(this.parts.surface, () => this.covered(), () => this.draw());
    this.overlay = new Overlay(this.parts.overlay, settings);
    this.refit = new Refit(this.parts, backend, () => this.draw());
    this.files = new Files(this, this.parts, backend);
    this.placing = new Placing(this, this.parts, settings);
    this.panel = new Panel(this.parts, settings, {
      select: (k, more) => this.select([k], more),
      put: (axis, value) => this.put(axis, value),
      miss: (isMissing) => this.miss(isMissing),
    });
    this.gestures = new Gestures(this.parts.surface, this.view, this);
    this.listen(root);
  }

  listen(root) {
    const { parts, view } = this;
    listenKeys(root, parts.surface, this, view);
    const acts = {
      undo: () => this.step(-1), redo: () => this.step(1), save: () => this.save(), help: () => this.help(),
      previous: () => this.go(-1), next: () => this.go(1), in: () => view.zoom(ZOOM), out: () => view.zoom(1 / ZOOM),
      all: () => view.fit(), part: () => this.selectParts(), mirror: () => this.mirror(), detect: () => this.files.detect(),
      clicks: () => this.placing.begin(), front: () => this.refit.face?.front(),
    };
    for (const [name, act] of Object.entries(acts)) parts[name].addEventListener('click', act);
    for (const name of TOGGLES) parts[name].addEventListener('click', () => this.toggle(name));
    for (const input of root.querySelectorAll('.looks input')) {
      input.name = `look-${parts.points.id}`;
      input.addEventListener('change', () => this.refit.face?.wear(input.value));
    }
    parts.reach.value = this.settings.prior.reach;
    parts.detect.hidden = !this.settings.detector;
    this.observer = new ResizeObserver(() => view.resized());
    this.observer.observe(parts.surface);
  }

  async start() {
    await this.files.start();
  }

  end() {
    this.observer.disconnect();
  }

  // What is shown: the last step, or what a drag would make of it.
  get state() {
    return this.shownState ?? this.history.state;
  }

  // What the tools, or the question for a click in their place, cover of the picture.
  covered() {
    const { surface, bar, ask } = this.parts;
    return surface.clientHeight - (ask.hidden ? bar : ask).offsetTop;
  }

  get isPlacing() {
    return this.placing.isOn;
  }

  get isBoxing() {
    return this.on.box;
  }

  say(text, isWrong = false) {
    this.parts.status.textContent = text;
    this.parts.status.classList.toggle('wrong', isWrong);
    this.parts.status.classList.remove('past');
    clearTimeout(this.said);
    if (!isWrong) this.said = setTimeout(() => this.parts.status.classList.add('past'), SEEN);
  }

  // An answer, or null after its error was told.
  async ask(what, message) {
    try {
      return await this.backend.ask(what, message);
    } catch (error) {
      this.say(error.message, true);
      return null;
    }
  }

  open(first, isSaved) {
    this.history = new History(first);
    if (!isSaved) this.history.saved = -1;
    this.selection.clear();
    this.shownState = null;
    this.changed(true);
  }

  preview(next) {
    this.shownState = next;
    this.changed(next === null || this.isPlacing);
  }

  commit(kind = null) {
    if (this.shownState) this.history.add(this.shownState, kind);
    this.shownState = null;
    this.changed(true);
    this.kept();
  }

  // In a notebook there is nothing to save: the kernel hears of each step.
  kept() {
    if (this.settings.isWidget) this.files.keep();
  }

  changed(isFinal) {
    this.parts.undo.disabled = this.history.at === 0 && !this.isPlacing;
    this.parts.redo.disabled = this.history.at === this.history.steps.length - 1;
    this.files.tell();
    this.panel.show(this.state, this.selection);
    this.refit.run({ picture: this.files.current, state: this.state, isFinal });
    this.draw();
  }

  draw() {
    if (this.isDrawn === false) return;
    this.isDrawn = false;
    requestAnimationFrame(() => {
      this.isDrawn = true;
      this.files.paint(this.view);
      this.parts.overlay.classList.toggle('placing', this.isPlacing);
      this.overlay.draw(this.view, this.state, {
        selection: this.selection,
        near: this.near,
        fitted: this.on.fitted ? this.refit.landmarks : null,
      });
    });
  }

  // The nearest point, or a point of the nearest line, at CSS pixels; null if nothing is near.
  hit(at, radius) {
    const { points, missing } = this.state;
    const places = points.map((point) => this.view.toScreen(point));
    const away = ([x, y]) => Math.hypot(x - at[0], y - at[1]);
    const point = places.reduce((best, place, k) => (away(place) < away(places[best]) ? k : best), 0);
    if (away(places[point]) <= radius) return { point, isLine: false };
    for (const { first, last, closed } of this.settings.lines) {
      for (let k = first; k <= last; k++) {
        const next = k < last ? k + 1 : closed ? first : k;
        if (!missing[k] && !missing[next] && distance(at, places[k], places[next]) <= LINE) return { point: k, isLine: true };
      }
    }
    return null;
  }

  hover(hit) {
    const near = hit ? hit.point : null;
    this.parts.surface.classList.toggle('over', hit !== null);
    if (near === this.near) return;
    this.near = near;
    this.draw();
  }

  partOf(k) {
    return Object.values(this.settings.parts).find((points) => points.includes(k));
  }

  select(points, more) {
    const next = new Set(more ? this.selection : []);
    for (const k of points) {
      if (more && points.length === 1 && next.has(k)) next.delete(k);
      else next.add(k);
    }
    this.selection = next;
    this.panel.show(this.state, next);
    if (points.length === 1 && next.size === 1) this.say(this.where(points[0]));
    else this.say(next.size ? `${next.size} points selected` : '');
    this.draw();
  }

  selectParts() {
    this.select([...new Set([...this.selection].flatMap((k) => this.partOf(k)))], false);
  }

  selectBox(box, more) {
    this.rubber(null);
    const [[x, y], [u, v]] = box;
    const within = (value, a, b) => value >= Math.min(a, b) && value <= Math.max(a, b);
    const inside = this.all.filter((k) => {
      const [px, py] = this.view.toScreen(this.state.points[k]);
      return within(px, x, u) && within(py, y, v);
    });
    this.select(more ? [...this.selection, ...inside] : inside, false);
  }

  rubber(box) {
    this.overlay.rubber(box);
  }

  walk(step) {
    const last = [...this.selection].at(-1) ?? (step > 0 ? -1 : 0);
    this.select([(last + step + this.all.length) % this.all.length], false);
  }

  where(k) {
    const [x, y] = this.state.points[k];
    return `${k}, ${this.panel.words(k)}: ${this.state.missing[k] ? 'missing' : `x ${x.toFixed(1)}, y ${y.toFixed(1)}`}`;
  }

  drag() {
    const from = this.history.state;
    const placed = new Set(this.selection);
    const go = movement(from, placed, { ...this.on, reach: Number(this.parts.reach.value), settings: this.settings });
    return {
      to: (d) => this.preview(moved(from, go(d), placed)),
      end: () => {
        this.commit();
        if (placed.size === 1) this.say(this.where([...placed][0]));
      },
      undo: () => this.preview(null),
    };
  }

  nudge(d) {
    if (!this.selection.size || this.isPlacing) return;
    const drag = this.drag();
    drag.to(d);
    this.commit(`nudge ${[...this.selection]}`);
    if (this.selection.size === 1) this.say(this.where([...this.selection][0]));
  }

  put(axis, value) {
    const [k] = this.selection;
    if (k === undefined || !Number.isFinite(value)) return;
    const d = [0, 0];
    d[axis] = value - this.state.points[k][axis];
    this.nudge(d);
  }

  miss(isMissing) {
    const next = state(this.state.points, this.state.missing, this.state.confidence);
    for (const k of this.selection) next.missing[k] = isMissing;
    this.shownState = next;
    this.commit();
    this.say(isMissing ? 'Missing: the face does not mind these points' : 'No longer missing');
  }

  toggleMissing() {
    if (this.selection.size) this.miss(![...this.selection].every((k) => this.state.missing[k]));
  }

  // The selected points, as they would lie on the other side.
  mirror() {
    const { points, missing } = this.state;
    const { mirror: twins } = this.settings;
    const map = mirrorMap(points, missing, twins);
    const copied = [...this.selection].filter((k) => !this.selection.has(twins[k]));
    if (!map || !copied.length) {
      this.say('Select points of one side, which are then copied to the other');
      return;
    }
    const places = new Map(copied.map((k) => [twins[k], map.place(points[k]).map(rounded)]));
    this.shownState = moved(this.state, places, places.keys());
    this.commit();
    this.say(`${copied.length} points copied to the other side`);
  }

  toggle(name) {
    this.on[name] = !this.on[name];
    this.parts[name].setAttribute('aria-pressed', String(this.on[name]));
    this.parts.reaching.hidden = !this.on.soft;
    this.draw();
  }

  step(by) {
    if (this.isPlacing) {
      if (by < 0) this.placing.back();
      return;
    }
    if (!this.history.go(by)) return;
    this.changed(true);
    this.kept();
    this.say(by < 0 ? 'Undone' : 'Done again');
  }

  clickedAt(place) {
    this.placing.clicked(place);
  }

  endPlacing(keep) {
    this.placing.end(keep);
  }

  save() {
    return this.files.save();
  }

  go(by) {
    return this.files.go(by);
  }

  help() {
    help(this.parts, HELP);
  }

  question(text, answers) {
    return question(this.parts, text, answers);
  }

  scripted() {
    return {
      points: () => this.state.points,
      missing: () => this.state.missing,
      confidence: () => this.state.confidence,
      screen: (k) => this.scripted().pixel(this.state.points[k]),
      pixel: (place) => {
        const box = this.parts.surface.getBoundingClientRect();
        const [x, y] = this.view.toScreen(place);
        return [box.left + x, box.top + y];
      },
      scale: () => this.view.scale,
      select: (points) => this.select(points, false),
      selection: () => [...this.selection],
      fits: () => this.refit.count,
      face: () => this.refit.face?.middle(),
    };
  }
}

function distance([x, y], [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const along = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}
