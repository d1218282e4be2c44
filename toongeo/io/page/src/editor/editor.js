// The landmark editor: what is selected, how points move, and what is drawn.
import { help, question } from './dialog.js';
import { Edits } from './edits.js';
import { Files } from './files.js';
import { Gestures } from './gestures.js';
import { listenKeys } from './keys.js';
import { History, state } from './landmarks.js';
import { Overlay } from './overlay.js';
import { Panel } from './panel.js';
import { inBox, pick } from './picking.js';
import { Placing } from './placing.js';
import { Refit } from './refit.js';
import { HELP, TEMPLATE } from './template.js';
import { View } from './view.js';

const TOGGLES = ['box', 'soft', 'both', 'fitted'];
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
    this.edits = new Edits(this, this.parts, settings);
    this.placing = new Placing(this, this.parts, settings);
    this.panel = new Panel(this.parts, settings, {
      select: (k, more) => this.select([k], more),
      put: (axis, value) => this.edits.put(axis, value),
      miss: (isMissing) => this.edits.miss(isMissing),
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
      all: () => view.fit(), part: () => this.selectParts(), mirror: () => this.edits.mirror(), detect: () => this.files.detect(),
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
    this.refit.face?.stage.renderer.dispose();
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

  get isOpen() {
    return this.files.isOpen;
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
    if (this.isOpen) this.refit.run({ picture: this.files.current, state: this.state, isFinal });
    this.draw();
  }

  draw() {
    if (this.isDrawn === false) return;
    this.isDrawn = false;
    requestAnimationFrame(() => {
      this.isDrawn = true;
      this.files.paint(this.view);
      this.parts.overlay.classList.toggle('placing', this.isPlacing);
      this.parts.overlay.classList.toggle('closed', !this.isOpen);
      this.overlay.draw(this.view, this.state, {
        selection: this.selection,
        near: this.near,
        fitted: this.on.fitted ? this.refit.landmarks : null,
      });
    });
  }

  // The nearest point, or a point of the nearest line, at CSS pixels; null if nothing is near.
  hit(at, radius) {
    return this.isOpen ? pick(at, radius, this.places, this.state.missing, this.settings.lines) : null;
  }

  get places() {
    return this.state.points.map((point) => this.view.toScreen(point));
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
    this.sayWhere();
    this.draw();
  }

  selectParts() {
    this.select([...new Set([...this.selection].flatMap((k) => this.partOf(k)))], false);
  }

  selectBox(box, more) {
    this.rubber(null);
    const inside = inBox(box, this.places);
    this.select(more ? [...this.selection, ...inside] : inside, false);
  }

  rubber(box) {
    this.overlay.rubber(box);
  }

  walk(step) {
    const last = [...this.selection].at(-1) ?? (step > 0 ? -1 : 0);
    this.select([(last + step + this.all.length) % this.all.length], false);
  }

  // What is selected, for those who do not see it.
  sayWhere() {
    const [k] = this.selection;
    if (this.selection.size !== 1) {
      this.say(this.selection.size ? `${this.selection.size} points selected` : '');
      return;
    }
    const [x, y] = this.state.points[k];
    this.say(`${k}, ${this.panel.words(k)}: ${this.state.missing[k] ? 'missing' : `x ${x.toFixed(1)}, y ${y.toFixed(1)}`}`);
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
}
