// Clicks, taps and a crosshair for the keyboard: places in CSS pixels of the canvas.
const STILL = 5; // CSS px that a click may move, or a tap of a finger that rolls
const STEP = 12; // CSS px of the crosshair
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Pointer {
  constructor(surface, canvas, cross, act) {
    this.surface = surface;
    this.canvas = canvas;
    this.cross = cross;
    this.act = act;
    this.down = new Map();
    canvas.addEventListener('pointerdown', (event) => this.pressed(event));
    canvas.addEventListener('pointermove', (event) => this.moved(event));
    canvas.addEventListener('pointerup', (event) => this.released(event));
    canvas.addEventListener('pointercancel', (event) => this.down.delete(event.pointerId));
    canvas.addEventListener('pointerleave', () => act.hover(null));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    // Before the stage, which turns the head by arrow keys.
    surface.addEventListener('keydown', (event) => this.key(event), true);
    canvas.addEventListener('blur', () => this.aim(null));
  }

  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  pressed(event) {
    this.aim(null);
    if (this.down.size) this.down.forEach((start) => (start.isClick = false)); // two fingers
    this.down.set(event.pointerId, { at: this.place(event), isClick: event.button === 0 && !this.down.size && !event.shiftKey });
    this.act.hover(null);
  }

  moved(event) {
    const start = this.down.get(event.pointerId);
    if (!start) {
      if (event.pointerType === 'mouse') this.act.hover(this.place(event));
      return;
    }
    const [x, y] = this.place(event);
    if (Math.hypot(x - start.at[0], y - start.at[1]) > STILL) start.isClick = false;
  }

  released(event) {
    const start = this.down.get(event.pointerId);
    this.down.delete(event.pointerId);
    if (start?.isClick) this.act.pick(start.at);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey) return;
    const step = event.shiftKey ? ARROWS[event.key] : null;
    if (step) this.aim((this.at ?? this.middle).map((value, axis) => value + step[axis] * (event.altKey ? 1 : STEP)));
    else if (event.key === 'Enter' || event.key === ' ') this.act.pick(this.at ?? this.aim(this.middle));
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  get middle() {
    return [this.canvas.clientWidth / 2, this.canvas.clientHeight / 2];
  }

  // Puts the crosshair somewhere, or away.
  aim(place) {
    const size = [this.canvas.clientWidth, this.canvas.clientHeight];
    this.at = place && place.map((value, axis) => Math.min(Math.max(value, 0), size[axis]));
    this.cross.hidden = this.at === null;
    if (this.at) {
      this.cross.style.translate = this.at.map((value) => `${value}px`).join(' ');
      this.act.hover(this.at);
    }
    return this.at;
  }
}
