// The panel: the selection in numbers, and all points as a list for keyboards and screen readers.
import { inWords } from '../regions.js';
import { sureness } from './overlay.js';

export class Panel {
  constructor(parts, settings, act) {
    this.parts = parts;
    this.settings = settings;
    this.cursor = 0;
    this.options = this.fill();
    for (const [axis, id] of ['x', 'y'].entries()) {
      parts[id].addEventListener('change', () => act.put(axis, Number(parts[id].value)));
    }
    parts.missing.addEventListener('change', () => act.miss(parts.missing.checked));
    parts.points.addEventListener('click', (event) => {
      const option = event.target.closest('[role=option]');
      if (option) this.choose(this.options.indexOf(option), event.shiftKey || event.ctrlKey || event.metaKey, act);
    });
    parts.points.addEventListener('keydown', (event) => this.key(event, act));
  }

  fill() {
    const options = [];
    for (const [part, points] of Object.entries(this.settings.parts)) {
      const group = make('div', { role: 'group', 'aria-label': inWords(part) });
      group.append(make('span', { class: 'part', 'aria-hidden': 'true' }, inWords(part)));
      for (const k of points) {
        const option = make('div', { role: 'option', 'aria-selected': 'false', id: `${this.parts.points.id}-${k}` });
        option.append(make('span', { class: 'number' }, String(k)), make('span', { class: 'words' }, this.words(k)), make('span', { class: 'state' }));
        options[k] = option;
        group.append(option);
      }
      this.parts.points.append(group);
    }
    return options;
  }

  words(k) {
    return inWords(this.settings.names[k]);
  }

  choose(k, more, act) {
    this.cursor = k;
    act.select(k, more);
  }

  key(event, act) {
    const step = { ArrowDown: 1, ArrowUp: -1, Home: -68, End: 68 }[event.key];
    if (step === undefined && event.key !== ' ' && event.key !== 'Enter') return;
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (step === undefined) this.choose(this.cursor, event.key === ' ', act);
    else this.choose(Math.min(Math.max(this.cursor + step, 0), this.options.length - 1), event.shiftKey, act);
  }

  show({ points, missing, confidence }, selection) {
    const { parts } = this;
    const chosen = [...selection];
    const only = chosen.length === 1 ? chosen[0] : null;
    parts.chosen.textContent = only !== null ? `${only} · ${this.words(only)}` : chosen.length ? `${chosen.length} points selected` : 'No point selected';
    for (const [axis, id] of ['x', 'y'].entries()) {
      parts[id].disabled = only === null;
      parts[id].value = only === null ? '' : points[only][axis].toFixed(2);
    }
    parts.missing.disabled = !chosen.length;
    parts.missing.checked = chosen.length > 0 && chosen.every((k) => missing[k]);
    parts.part.disabled = parts.mirror.disabled = !chosen.length;
    if (only !== null) this.cursor = only;
    this.options.forEach((option, k) => {
      const state = missing[k] ? 'missing' : sureness(confidence[k]);
      option.setAttribute('aria-selected', String(selection.has(k)));
      option.className = state;
      option.lastChild.textContent = missing[k] ? 'missing' : sure(confidence[k]);
    });
    parts.points.setAttribute('aria-activedescendant', this.options[this.cursor].id);
    if (only !== null && document.activeElement === parts.points) this.options[only].scrollIntoView({ block: 'nearest' });
  }
}

function sure(confidence) {
  return confidence === null ? '' : confidence === 0 ? 'guessed' : `${Math.round(100 * confidence)} %`;
}

export function make(tag, attributes = {}, text = null) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== null) element.textContent = text;
  return element;
}
