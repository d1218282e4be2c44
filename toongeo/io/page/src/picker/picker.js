// The landmark picker: which point is asked for, which vertices the points have, and what is saved.
import { Color } from 'three';
import { help, question } from '../editor/dialog.js';
import { unpacked } from '../editor/face.js';
import { History } from '../editor/landmarks.js';
import { make } from '../editor/panel.js';
import { Head } from './head.js';
import { PointList, stateOf } from './list.js';
import { Pointer } from './pointer.js';
import { counts, emptyState, nextToPick, put, removed, started } from './points.js';
import { HELP, TEMPLATE } from './template.js';

const COLOURS = { placed: new Color(0x3f8fd2), rather: new Color(0xe9b949), current: new Color(0xf0662f), hover: new Color(0xffffff) };
const ZOOM = 1.25;

export class Picker {
  constructor(root, settings, backend) {
    root.classList.add('picker');
    root.innerHTML = TEMPLATE;
    this.parts = Object.fromEntries([...root.querySelectorAll('[data-id]')].map((part) => [part.dataset.id, part]));
    this.settings = settings;
    this.backend = backend;
    this.history = new History(emptyState(settings.names.length));
    this.current = settings.order[0];
    this.head = new Head(this.parts.canvas);
    this.list = new PointList(this.parts, settings, (k) => this.select(k));
    this.pointer = new Pointer(this.parts.surface, this.parts.canvas, this.parts.cross, {
      pick: (place) => this.pick(place),
      hover: (place) => this.hover(place),
    });
    this.listen(root);
  }

  get state() {
    return this.history.state;
  }

  listen(root) {
    const { parts, head } = this;
    const acts = {
      undo: () => this.step(-1), redo: () => this.step(1), save: () => this.save(), help: () => help(parts, HELP),
      back: () => this.walk(-1), skip: () => this.walk(1), remove: () => this.remove(), front: () => head.stage.front(),
      in: () => head.stage.turn(0, 0, ZOOM), out: () => head.stage.turn(0, 0, 1 / ZOOM),
    };
    for (const [name, act] of Object.entries(acts)) parts[name].addEventListener('click', act);
    parts.up.addEventListener('change', () => head.upright(parts.up.value));
    parts.vertex.addEventListener('change', () => this.typed());
    root.addEventListener('keydown', (event) => this.key(event));
    parts.format.append(...this.settings.formats.map((suffix) => make('option', { value: suffix }, suffix)));
    window.addEventListener('beforeunload', (event) => {
      if (!this.history.isSaved) event.preventDefault();
    });
  }

  key(event) {
    const isTyping = event.target.matches('input[type=number], select');
    const held = (event.ctrlKey || event.metaKey) && !event.altKey;
    const commands = { z: () => this.step(event.shiftKey ? 1 : -1), y: () => this.step(1), s: () => this.save() };
    const letters = { n: () => this.walk(1), p: () => this.walk(-1), Delete: () => this.remove(), Backspace: () => this.remove(), '?': () => help(this.parts, HELP) };
    const act = held ? commands[event.key.toLowerCase()] : isTyping || event.altKey ? null : letters[event.key] ?? letters[event.key.toLowerCase()];
    if (!act || this.parts.dialog.open || (isTyping && event.key.toLowerCase() !== 's')) return;
    event.preventDefault();
    act();
  }

  async start() {
    const { parts } = this;
    this.say('Loading the mesh…');
    try {
      const answer = await this.backend.ask('mesh');
      const vertices = unpacked(answer.vertices, Float32Array);
      const colours = answer.colours && unpacked(answer.colours, Uint8Array);
      this.count = vertices.length / 3;
      this.partners = answer.mirror && unpacked(answer.mirror, Uint32Array);
      this.head.show({ vertices, faces: unpacked(answer.faces, Uint32Array), colours });
      this.history = new History(started(answer.start));
      this.name = answer.name;
      parts.format.value = answer.suffix;
      parts.vertex.max = this.count - 1;
      parts.mirroring.hidden = !this.partners;
      this.select(this.state.vertices[this.current] === null ? this.current : nextToPick(this.state, this.settings.order, this.current));
      this.say(answer.note || this.greeting(), Boolean(answer.note));
      parts.picture.dataset.ready = 'true';
    } catch (error) {
      this.say(error.message, true);
    }
  }

  greeting() {
    if (counts(this.state).left < this.state.vertices.length) return 'These points are known already';
    return this.partners ? 'Click the points one after the other; the other side of the face is proposed' : 'Click the points one after the other';
  }

  // For those who do not see what changes.
  say(text, isWrong = false) {
    this.parts.status.textContent = text;
    this.parts.status.classList.toggle('wrong', isWrong);
  }

  select(k) {
    this.current = k;
    this.show();
  }

  walk(step) {
    const { order } = this.settings;
    this.select(order[(order.indexOf(this.current) + step + order.length) % order.length]);
    this.say(`${this.current}, ${this.list.words(this.current)}`);
  }

  pick(place) {
    if (!this.count) return;
    const vertex = this.head.hit(...place);
    if (vertex === null) this.say('There is nothing of the mesh');
    else this.set(vertex);
  }

  hover(place) {
    if (!this.count || !this.head.canHover) return;
    this.hovered = place;
    if (this.isHovering) return;
    this.isHovering = true;
    requestAnimationFrame(() => {
      this.isHovering = false;
      const vertex = this.hovered && this.head.hit(...this.hovered);
      this.head.mark({ hover: vertex === null ? [] : [[vertex, COLOURS.hover]] });
    });
  }

  typed() {
    const vertex = Number(this.parts.vertex.value);
    if (this.parts.vertex.value !== '' && Number.isInteger(vertex) && vertex >= 0 && vertex < this.count) {
      this.set(vertex, false);
    } else {
      this.say(`Vertices are numbered from 0 to ${this.count - 1}`, true);
      this.show();
    }
  }

  set(vertex, goOn = true) {
    const { current: k, settings, list } = this;
    const partners = this.parts.mirror.checked ? this.partners : null;
    this.history.add({ ...put(this.state, k, vertex, settings.mirror, partners), point: k });
    const next = goOn ? nextToPick(this.state, settings.order, k) : k;
    this.select(next);
    const { left, guessed } = counts(this.state);
    const more = left ? `next ${next}, ${list.words(next)}` : guessed ? 'all have a vertex: look at the proposed ones' : 'all 68 are picked';
    this.say(`${k}: vertex ${vertex}; ${more}`);
  }

  remove() {
    const k = this.current;
    if (this.state.vertices[k] === null) return;
    this.history.add({ ...removed(this.state, k, this.settings.mirror), point: k });
    this.show();
    this.say(`${k}, ${this.list.words(k)}: no vertex`);
  }

  step(by) {
    const changed = by > 0 ? this.history.steps[this.history.at + 1] : this.state;
    if (!this.history.go(by)) return;
    this.select(changed?.point ?? this.current);
    this.say(by < 0 ? 'Undone' : 'Done again');
  }

  show() {
    const { parts, state, current, list, settings } = this;
    const { picked, guessed, left } = counts(state);
    const isMiddle = settings.mirror[current] === current;
    const [x] = settings.face[current];
    list.show(state, current);
    parts.what.textContent = `${current} · ${list.words(current)}`;
    parts.progress.textContent = isMiddle ? 'in the middle' : `the subject's ${x < 0 ? 'right: on the left, seen from the front' : 'left: on the right, seen from the front'}`;
    parts.chosen.textContent = `${current} · ${list.words(current)}`;
    parts.vertex.value = state.vertices[current] ?? '';
    parts.remove.disabled = state.vertices[current] === null;
    parts.undo.disabled = this.history.at === 0;
    parts.redo.disabled = this.history.at === this.history.steps.length - 1;
    parts.save.disabled = picked + guessed === 0;
    parts.name.textContent = this.name ?? 'Landmarks';
    const proposed = guessed ? [make('span', { class: 'wide' }, ` · ${guessed} of them proposed`)] : [];
    parts.count.replaceChildren(`${picked + guessed} of ${picked + guessed + left}`, ...proposed, this.history.isSaved ? '' : ' · not saved');
    parts.count.classList.toggle('unsaved', !this.history.isSaved);
    document.title = `${this.history.isSaved ? '' : '• '}${this.name ?? 'Landmarks'}`;
    this.mark();
  }

  mark() {
    if (!this.count) return;
    const { state, current } = this;
    const shown = state.vertices.flatMap((vertex, k) => (vertex === null || k === current ? [] : [[vertex, COLOURS[stateOf(state, k)]]]));
    this.head.mark({ point: shown, current: state.vertices[current] === null ? [] : [[state.vertices[current], COLOURS.current]] });
  }

  async save(replace = false) {
    const saved = this.history.at;
    try {
      const answer = await this.backend.ask('save', { vertices: this.state.vertices, suffix: this.parts.format.value, replace });
      if (answer.exists) {
        const choice = await question(this.parts, `${answer.exists} is there already. Replace it?`, ['Replace', 'Cancel']);
        return choice === 0 ? this.save(true) : false;
      }
      if (this.history.at === saved) this.history.markSaved();
      const { left } = counts(this.state);
      this.show();
      this.say(`Saved ${answer.file}${left ? `, ${left} points missing: enough to rig the mesh, but a model needs all` : ''}`);
      return true;
    } catch (error) {
      this.say(error.message, true);
      return false;
    }
  }
}

// What scripts and tests may ask of the picker.
export function scriptedPicker(picker) {
  const inPage = (vertex) => {
    const box = picker.parts.canvas.getBoundingClientRect();
    return picker.head.screen(vertex).map((value, axis) => value + [box.left, box.top][axis]);
  };
  return {
    vertices: () => picker.state.vertices,
    proposed: () => picker.state.proposed,
    current: () => picker.current,
    select: (k) => picker.select(k),
    screen: inPage,
    turn: (sideways, up, nearer) => picker.head.stage.turn(sideways, up, nearer),
  };
}
