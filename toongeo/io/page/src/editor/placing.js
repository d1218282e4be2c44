// A face placed by a few clicks: the editor asks for points one after the other and completes them.
import { state } from './landmarks.js';
import { rounded } from './movement.js';

const SVG = 'http://www.w3.org/2000/svg';

export class Placing {
  constructor(editor, parts, settings) {
    this.editor = editor;
    this.parts = parts;
    this.settings = settings;
    this.isOn = false;
    parts.skip.addEventListener('click', () => this.go(1));
    parts.cancel.addEventListener('click', () => this.end(false));
    parts.done.addEventListener('click', () => this.end(true));
    this.mark = this.sketch();
  }

  // A small face that shows which point is meant.
  sketch() {
    const { face, lines } = this.settings;
    const add = (tag, attributes) => {
      const element = document.createElementNS(SVG, tag);
      for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
      this.parts.sketch.append(element);
      return element;
    };
    for (const { first, last, closed } of lines) {
      add('path', { d: `M${face.slice(first, last + 1).map((point) => point.join(',')).join('L')}${closed ? 'Z' : ''}` });
    }
    return add('circle', { r: 0.075 });
  }

  begin() {
    if (this.isOn || !this.editor.isOpen) return;
    this.isOn = true;
    this.before = this.editor.state;
    this.clicks = this.before.points.map(() => null);
    this.at = 0;
    this.trail = [];
    this.ask(true);
    this.editor.select([], false);
    this.show();
    this.editor.preview(this.given());
  }

  // The question takes the place of the tools.
  ask(isOn) {
    this.parts.ask.hidden = !isOn;
    this.parts.bar.hidden = isOn;
    this.editor.view.resized();
  }

  get count() {
    return this.clicks.filter(Boolean).length;
  }

  // Only what was clicked.
  given() {
    const points = this.before.points.map((point, k) => this.clicks[k] ?? point);
    return state(points, this.clicks.map((click) => !click));
  }

  show() {
    const { point, what } = this.settings.clicks[this.at];
    const [x, y] = this.settings.face[point];
    this.parts.what.textContent = `Click the ${what}`;
    const more = this.settings.fewestClicks - this.count;
    this.parts.progress.textContent = `${this.at + 1} of ${this.settings.clicks.length}${more > 0 ? '' : ' · six are good, twelve better'}`;
    this.parts.done.disabled = more > 0;
    this.mark.setAttribute('cx', x);
    this.mark.setAttribute('cy', y);
  }

  async clicked(place) {
    const { point } = this.settings.clicks[this.at];
    this.clicks[point] = place.map(rounded);
    this.trail.push(this.at);
    await this.complete();
    this.go(1);
  }

  go(step) {
    if (!this.isOn) return;
    if (this.at + step >= this.settings.clicks.length) {
      this.end(this.count >= this.settings.fewestClicks);
      return;
    }
    this.at += step;
    this.show();
  }

  async back() {
    if (!this.trail.length) return;
    this.at = this.trail.pop();
    this.clicks[this.settings.clicks[this.at].point] = null;
    this.show();
    await this.complete();
  }

  async complete() {
    if (this.count < this.settings.fewestClicks) {
      this.editor.preview(this.given());
      return;
    }
    const asked = [...this.clicks];
    const answer = await this.editor.ask('place', { clicks: asked });
    if (!answer || !this.isOn || asked.some((click, k) => click !== this.clicks[k])) return;
    const guessed = asked.map((click) => (click ? null : 0));
    this.editor.preview(state(answer.points.map((point) => point.map(rounded)), null, guessed));
  }

  end(keep) {
    if (!this.isOn) return;
    this.isOn = false;
    this.ask(false);
    if (keep && this.count >= this.settings.fewestClicks) this.editor.commit();
    else this.editor.preview(null);
    this.editor.say(keep ? 'Placed. Orange points are guessed: drag those that are off.' : 'Points are as before');
  }
}
