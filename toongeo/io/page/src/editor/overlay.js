// Points and lines over the picture, as SVG.
const SVG = 'http://www.w3.org/2000/svg';
const UNSURE = 0.5; // below it a point's ring is wide and orange
const RATHER_SURE = 0.8;

export class Overlay {
  constructor(svg, settings) {
    this.svg = svg;
    this.settings = settings;
    this.lines = settings.lines.flatMap(() => [this.add('path', 'halo'), this.add('path', 'line')]);
    this.model = this.add('path', 'model');
    this.points = settings.names.map(() => this.add('circle', 'point'));
    this.band = this.add('rect', 'band');
  }

  add(tag, name) {
    const element = document.createElementNS(SVG, tag);
    element.setAttribute('class', name);
    this.svg.append(element);
    return element;
  }

  // Marks: selection (Set), near (the point under the pointer) and fitted (places of the fitted face), or null.
  draw(view, { points, missing, confidence }, { selection, near, fitted }) {
    const places = points.map((point) => view.toScreen(point));
    const [right, left] = this.settings.eyes.map((k) => places[k]);
    const radius = Math.min(Math.max(0.03 * Math.hypot(right[0] - left[0], right[1] - left[1]), 2.2), 5);
    this.settings.lines.forEach((line, k) => {
      const path = lineOf(line, places, missing);
      for (const element of [this.lines[2 * k], this.lines[2 * k + 1]]) {
        element.setAttribute('d', path);
        element.classList.toggle('near', near !== null && near >= line.first && near <= line.last);
      }
    });
    places.forEach(([x, y], k) => {
      const circle = this.points[k];
      circle.setAttribute('cx', x);
      circle.setAttribute('cy', y);
      circle.setAttribute('r', radius * (selection.has(k) ? 1.3 : 1));
      circle.setAttribute('class', `point ${missing[k] ? 'missing' : sureness(confidence[k])}${selection.has(k) ? ' selected' : ''}${near === k ? ' near' : ''}`);
    });
    this.model.setAttribute('d', fitted ? fitted.map((point) => cross(view.toScreen(point))).join('') : '');
  }

  rubber(box) {
    this.band.classList.toggle('on', box !== null);
    if (!box) return;
    const [[x, y], [u, v]] = box;
    for (const [name, value] of [['x', Math.min(x, u)], ['y', Math.min(y, v)], ['width', Math.abs(x - u)], ['height', Math.abs(y - v)]]) {
      this.band.setAttribute(name, value);
    }
  }
}

export function sureness(confidence) {
  if (confidence === null) return 'placed';
  return confidence < UNSURE ? 'unsure' : confidence < RATHER_SURE ? 'rather' : 'sure';
}

// A path through a line's points; missing ones break it.
function lineOf({ first, last, closed }, places, missing) {
  const way = Array.from({ length: last - first + 1 }, (_, k) => first + k);
  if (closed) way.push(first);
  return way
    .slice(1)
    .map((k, i) => [way[i], k])
    .filter(([a, b]) => !missing[a] && !missing[b])
    .map(([a, b]) => `M${places[a].map(short)}L${places[b].map(short)}`)
    .join('');
}

function cross([x, y]) {
  return `M${short(x - 3)},${short(y)}h6M${short(x)},${short(y - 3)}v6`;
}

function short(value) {
  return value.toFixed(2);
}
