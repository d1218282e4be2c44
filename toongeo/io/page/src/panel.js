// Presets, sliders by region, search. Names come from a file, so they are only ever text.
import { byRegion, inWords, otherSide } from './regions.js';

const OPEN = new Set(['Mouth', 'Eyes', 'More']);
const MOVED = 0.004; // less is not seen

export function buildPanel(names, presets, changed) {
  const rows = new Map();
  const homes = [];

  function show(weights) {
    for (const [name, weight] of Object.entries(weights)) {
      const row = rows.get(name);
      if (!row) continue;
      row.input.value = weight;
      row.output.textContent = Number(weight).toFixed(2);
      row.label.classList.toggle('moved', Math.abs(weight) > MOVED);
    }
  }

  function move(weights) {
    show(weights);
    changed(weights);
  }

  function slider(name) {
    const label = element('label', { className: 'slider' });
    const output = element('output', { textContent: '0.00' });
    output.setAttribute('aria-hidden', 'true'); // the slider says it
    const input = element('input', { type: 'range', min: 0, max: 1, step: 0.01, value: 0, name });
    label.append(element('span', { textContent: inWords(name), title: name }), input, output);
    input.addEventListener('input', () => {
      const other = byId('mirror').checked ? otherSide(name, names) : null;
      move({ [name]: Number(input.value), ...(other && { [other]: Number(input.value) }) });
    });
    rows.set(name, { label, input, output });
    return label;
  }

  function group(title, open) {
    const details = element('details', { open });
    const body = document.createElement('div');
    const summary = element('summary', { textContent: title });
    details.append(summary, body);
    return { details, summary, body };
  }

  for (const [region, members] of byRegion(names)) {
    const { details, body } = group(`${region} (${members.length})`, OPEN.has(region));
    members.forEach(slider);
    homes.push([body, members]);
    byId('sliders').append(details);
  }
  // What a preset moves stands above all others, as long as it is pressed.
  const first = group('', true);
  byId('sliders').prepend(first.details);

  function press(chosen) {
    for (const button of byId('presets').querySelectorAll('button')) button.setAttribute('aria-pressed', button === chosen);
    for (const [body, members] of homes) body.append(...members.map((name) => rows.get(name).label));
    const parts = chosen ? Object.keys(presets[chosen.dataset.name]) : [];
    first.body.append(...parts.map((name) => rows.get(name).label));
    first.summary.textContent = chosen ? `${chosen.textContent} moves (${parts.length})` : '';
    first.details.hidden = !chosen;
    first.details.open = true;
    for (const [body] of homes) body.parentElement.classList.toggle('hidden', !body.children.length);
  }

  const rest = () => Object.fromEntries(names.map((name) => [name, 0]));
  byId('reset').addEventListener('click', () => {
    press(null);
    move(rest());
  });
  for (const [title, weights] of Object.entries(presets)) {
    if (!Object.keys(weights).every((name) => names.includes(name))) continue;
    const button = element('button', { type: 'button', textContent: inWords(title) });
    button.dataset.name = title;
    button.addEventListener('click', () => {
      const on = button.getAttribute('aria-pressed') !== 'true';
      press(on ? button : null);
      move(on ? { ...rest(), ...weights } : rest());
    });
    byId('presets').append(button);
    byId('presets').hidden = false;
  }
  press(null);
  byId('both').hidden = !names.some((name) => otherSide(name, names));
  byId('sides').hidden = byId('both').hidden;
  byId('find').addEventListener('input', (event) => find(event.target.value));
  byId('sliders').addEventListener('submit', (event) => event.preventDefault());

  function find(text) {
    const wanted = text.trim().toLowerCase();
    for (const [name, row] of rows) row.label.hidden = !`${name} ${inWords(name)}`.toLowerCase().includes(wanted);
    for (const details of byId('sliders').children) {
      const found = details.querySelector('.slider:not([hidden])');
      details.hidden = !found;
      if (wanted && found) details.open = true;
    }
  }

  return { show, move, release: () => press(null) };
}

export function byId(id) {
  return document.getElementById(id);
}

function element(tag, properties) {
  return Object.assign(document.createElement(tag), properties);
}
