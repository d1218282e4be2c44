// Which part of the picture is seen: CSS pixels are `scale * (px + 0.5) + shift`, since an integer is a pixel's centre.
const MOST_SCALE = 40;
const MARGIN = 0.04;

export class View {
  // `covered`: how many CSS px at the bottom of the box other things lie on.
  constructor(box, covered, redraw) {
    this.box = box;
    this.covered = covered;
    this.redraw = redraw;
    this.scale = 1;
    this.shift = [0, 0];
    this.size = [1, 1];
    this.isFitted = true;
  }

  show(width, height) {
    this.size = [width, height];
    this.fit();
  }

  get seen() {
    return [this.box.clientWidth, this.box.clientHeight];
  }

  get free() {
    const [width, height] = this.seen;
    return [width, Math.max(height - this.covered(), 1)];
  }

  fit() {
    const [width, height] = this.free;
    this.least = Math.min(width / this.size[0], height / this.size[1]) * (1 - MARGIN);
    this.scale = this.least;
    this.shift = [(width - this.scale * this.size[0]) / 2, (height - this.scale * this.size[1]) / 2];
    this.isFitted = true;
    this.redraw();
  }

  // Fills the view with a box of the picture.
  frame([left, top], [right, bottom]) {
    const [width, height] = this.free;
    this.scale = Math.min(width / (right - left), height / (bottom - top), MOST_SCALE);
    this.shift = [width / 2 - this.scale * ((left + right) / 2 + 0.5), height / 2 - this.scale * ((top + bottom) / 2 + 0.5)];
    this.isFitted = false;
    this.redraw();
  }

  toScreen([x, y]) {
    return [this.scale * (x + 0.5) + this.shift[0], this.scale * (y + 0.5) + this.shift[1]];
  }

  toPicture([x, y]) {
    return [(x - this.shift[0]) / this.scale - 0.5, (y - this.shift[1]) / this.scale - 0.5];
  }

  // Nearer by a factor; what lies at `centre` stays there.
  zoom(factor, centre = this.seen.map((side) => side / 2)) {
    const scale = Math.min(Math.max(this.scale * factor, this.least / 4), Math.max(MOST_SCALE, this.least));
    this.shift = this.shift.map((shift, axis) => centre[axis] - (scale / this.scale) * (centre[axis] - shift));
    this.scale = scale;
    this.isFitted = false;
    this.redraw();
  }

  pan(dx, dy) {
    const [width, height] = this.seen;
    const keep = 40; // CSS px of the picture that stay in sight
    this.shift[0] = Math.min(Math.max(this.shift[0] + dx, keep - this.scale * this.size[0]), width - keep);
    this.shift[1] = Math.min(Math.max(this.shift[1] + dy, keep - this.scale * this.size[1]), height - keep);
    this.isFitted = false;
    this.redraw();
  }

  resized() {
    if (this.isFitted) this.fit();
    else this.redraw();
  }
}
