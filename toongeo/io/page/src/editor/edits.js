// What is done to the selected points; each is a step that can be undone.
import { moved, state } from './landmarks.js';
import { mirrorMap } from './mirror.js';
import { movement, rounded } from './movement.js';

export class Edits {
  constructor(editor, parts, settings) {
    this.editor = editor;
    this.parts = parts;
    this.settings = settings;
  }

  get isIdle() {
    return !this.editor.selection.size || this.editor.isPlacing || !this.editor.isOpen;
  }

  // A drag that has begun: to(displacement in px), end(), undo().
  drag() {
    const { editor } = this;
    const from = editor.history.state;
    const placed = new Set(editor.selection);
    const go = movement(from, placed, { ...editor.on, reach: Number(this.parts.reach.value), settings: this.settings });
    return {
      to: (d) => editor.preview(moved(from, go(d), placed)),
      end: () => {
        editor.commit();
        editor.sayWhere();
      },
      undo: () => editor.preview(null),
    };
  }

  nudge(d) {
    if (this.isIdle) return;
    this.drag().to(d);
    this.editor.commit(`nudge ${[...this.editor.selection]}`);
    this.editor.sayWhere();
  }

  // One coordinate of the selected point, as it was typed.
  put(axis, value) {
    const [k] = this.editor.selection;
    if (k === undefined || !Number.isFinite(value)) return;
    const d = [0, 0];
    d[axis] = value - this.editor.state.points[k][axis];
    this.nudge(d);
  }

  miss(isMissing) {
    if (this.isIdle) return;
    const { editor } = this;
    const next = state(editor.state.points, editor.state.missing, editor.state.confidence);
    for (const k of editor.selection) next.missing[k] = isMissing;
    this.make(next, isMissing ? 'Missing: the face does not mind these points' : 'No longer missing');
  }

  toggleMissing() {
    this.miss(![...this.editor.selection].every((k) => this.editor.state.missing[k]));
  }

  // The selected points, as they would lie on the other side.
  mirror() {
    if (this.isIdle) return;
    const { selection, state: from } = this.editor;
    const { mirror: twins } = this.settings;
    const map = mirrorMap(from.points, from.missing, twins);
    const copied = [...selection].filter((k) => !selection.has(twins[k]));
    if (!map || !copied.length) {
      this.editor.say('Select points of one side, which are then copied to the other');
      return;
    }
    const places = new Map(copied.map((k) => [twins[k], map.place(from.points[k]).map(rounded)]));
    this.make(moved(from, places, places.keys()), `${copied.length} points copied to the other side`);
  }

  make(next, text) {
    this.editor.preview(next);
    this.editor.commit();
    this.editor.say(text);
  }
}
