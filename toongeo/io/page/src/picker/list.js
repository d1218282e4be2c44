// The points as a list, and as a little face.
import { make } from '../editor/panel.js';
import { inWords } from '../regions.js';

const SVG = 'http://www.w3.org/2000/svg';

export function stateOf({ vertices, proposed }, k) {
  return vertices[k] === null ? 'missing' : proposed[k] ? 'rather' : 'placed';
}

export class PointList {
  constructor(parts, settings, select) {
    this.parts = parts;
    this.settings = settings;
    this.select = select;
    parts.points.id = 'toongeo-points';
    this.options = [];
    for (const [part, points] of Object.entries(settings.parts)) this.group(part, points);
    this.dots = this.sketch();
    parts.points.addEventListener('keydown', (event) => this.key(event));
    parts.points.addEventListener('click', (event) => {
      const option = event.target.closest('[role=option]');
      if (option) select(this.options.indexOf(option));
    });
  }

  words(k) {
    return inWords(this.settings.names[k]);
  }

  group(part, points) {
    const group = make('div', { role: 'group', 'aria-label': inWords(part) });
    group.append(make('span', { class: 'part', 'aria-hidden': 'true' }, inWords(part)));
    for (const k of points) {
      const option = make('div', { role: 'option', 'aria-selected': 'false', id: `toongeo-points-${k}` });
      option.append(make('span', { class: 'number' }, String(k)), make('span', { class: 'words' }, this.words(k)), make('span', { class: 'state' }));
      this.options[k] = option;
      group.append(option);
    }
    this.parts.points.append(group);
  }

  // The template's face; a click on a point selects it.
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
    const dots = face.map(([cx, cy]) => add('circle', { r: 0.024, cx, cy }));
    this.parts.sketch.addEventListener('click', (event) => {
      const matrix = this.parts.sketch.getScreenCTM().inverse();
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
      const away = ([u, v]) => Math.hypot(u - x, v - y);
      this.select(face.reduce((best, point, k) => (away(point) < away(face[best]) ? k : best), 0));
    });
    return dots;
  }

  key(event) {
    const step = { ArrowDown: 1, ArrowUp: -1, Home: -68, End: 68 }[event.key];
    if (step === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    this.select(Math.min(Math.max(this.current + step, 0), this.options.length - 1));
  }

  show(state, current) {
    this.current = current;
    this.options.forEach((option, k) => {
      const kind = stateOf(state, k);
      option.className = kind;
      option.setAttribute('aria-selected', String(k === current));
      option.lastChild.textContent = state.vertices[k] === null ? '' : `${state.proposed[k] ? 'proposed ' : ''}${state.vertices[k]}`;
      this.dots[k].setAttribute('class', `${kind}${k === current ? ' current' : ''}`);
      this.dots[k].setAttribute('r', k === current ? 0.07 : 0.024);
    });
    this.parts.sketch.append(this.dots[current]); // above the others
    this.parts.points.setAttribute('aria-activedescendant', this.options[current].id);
    // On a phone the list scrolls with all else, which should stay in sight.
    const isAlone = getComputedStyle(this.parts.list).overflowY === 'auto';
    if (isAlone || document.activeElement === this.parts.points) this.options[current].scrollIntoView({ block: 'nearest' });
  }
}
