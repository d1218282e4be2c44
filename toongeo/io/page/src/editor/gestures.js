// Mouse, pen and fingers on the picture.
const NEAR = { mouse: 11, pen: 13, touch: 24 }; // CSS px within which a point is hit
const STILL = 3; // CSS px that a pointer may shake in a click
const WHEEL = 0.0015; // of the logarithm of the scale, a px of the wheel

export class Gestures {
  constructor(surface, view, editor) {
    this.surface = surface;
    this.view = view;
    this.editor = editor;
    this.pointers = new Map();
    this.act = null;
    surface.addEventListener('pointerdown', (event) => this.down(event));
    surface.addEventListener('pointermove', (event) => this.move(event));
    surface.addEventListener('pointerup', (event) => this.up(event));
    surface.addEventListener('pointercancel', (event) => this.cancel(event));
    surface.addEventListener('pointerleave', () => this.editor.hover(null));
    surface.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    surface.addEventListener('dblclick', (event) => this.twice(event));
  }

  place(event) {
    const box = this.surface.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  down(event) {
    if (event.pointerType === 'mouse' && event.button === 2) return;
    this.surface.setPointerCapture(event.pointerId);
    const at = this.place(event);
    this.pointers.set(event.pointerId, at);
    if (this.pointers.size === 2) {
      this.act?.undo?.();
      this.act = this.pinch();
    } else if (this.pointers.size === 1) {
      this.act = this.begin(event, at);
    }
  }

  // What a pointer that goes down will do: { to(place), end(), undo(), click() }.
  begin(event, at) {
    const { editor, view } = this;
    const more = event.shiftKey || event.ctrlKey || event.metaKey;
    if (event.button === 1 || editor.isPanning) return this.panning(at);
    if (editor.isPlacing) return { ...this.panning(at), click: () => editor.clickedAt(view.toPicture(at)) };
    const hit = editor.hit(at, NEAR[event.pointerType] ?? NEAR.mouse);
    if (hit !== null) {
      if (more) {
        editor.select([hit.point], true);
        return {};
      }
      const grabbed = hit.isLine ? editor.partOf(hit.point) : [hit.point];
      if (!grabbed.every((k) => editor.selection.has(k))) editor.select(grabbed, false);
      return this.dragging(at);
    }
    if (more || editor.isBoxing) return this.boxing(at, more);
    return { ...this.panning(at), click: () => editor.select([], false) };
  }

  panning(at) {
    let last = at;
    return {
      to: (place) => {
        this.view.pan(place[0] - last[0], place[1] - last[1]);
        last = place;
      },
    };
  }

  dragging(at) {
    let drag = null;
    return {
      to: (place) => {
        drag ??= this.editor.edits.drag();
        drag.to([place[0] - at[0], place[1] - at[1]].map((px) => px / this.view.scale));
      },
      end: () => drag?.end(),
      undo: () => drag?.undo(),
    };
  }

  boxing(at, more) {
    let to = at;
    return {
      to: (place) => {
        to = place;
        this.editor.rubber([at, to]);
      },
      end: () => this.editor.selectBox([at, to], more),
      undo: () => this.editor.rubber(null),
      click: () => this.editor.select([], more),
    };
  }

  pinch() {
    const fingers = () => [...this.pointers.values()];
    const span = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);
    const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    let last = fingers();
    return {
      isPinch: true,
      to: () => {
        const now = fingers();
        if (now.length < 2) return;
        const [from, to] = [middle(last), middle(now)];
        this.view.pan(to[0] - from[0], to[1] - from[1]);
        this.view.zoom(span(now) / Math.max(span(last), 1), to);
        last = now;
      },
    };
  }

  move(event) {
    const at = this.place(event);
    const start = this.pointers.get(event.pointerId);
    if (!start) {
      if (event.pointerType === 'mouse') this.editor.hover(this.editor.isPlacing ? null : this.editor.hit(at, NEAR.mouse));
      return;
    }
    if (this.act?.isPinch) this.pointers.set(event.pointerId, at);
    else if (!this.act?.isMoving && Math.hypot(at[0] - start[0], at[1] - start[1]) < STILL) return;
    if (this.act) {
      this.act.isMoving = true;
      this.act.to?.(at);
    }
  }

  up(event) {
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.pointers.size) {
      if (this.act?.isPinch) this.act = {}; // the finger that stays does nothing more
      return;
    }
    const { act } = this;
    this.act = null;
    if (act?.isMoving) act.end?.();
    else act?.click?.();
  }

  cancel(event) {
    this.act?.undo?.();
    this.act = null;
    this.pointers.delete(event.pointerId);
  }

  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 20 : 1;
    const faster = event.ctrlKey ? 6 : 1; // a pinch on a touch pad
    this.view.zoom(Math.exp(-event.deltaY * lines * faster * WHEEL), this.place(event));
  }

  twice(event) {
    if (this.editor.isPlacing) return;
    const hit = this.editor.hit(this.place(event), NEAR.mouse);
    if (hit !== null) this.editor.select(this.editor.partOf(hit.point), false);
  }
}
