// Sliders by region, presets, search. Names come from a file, so they are only ever text.
import { byRegion, inWords, otherSide } from './regions.js';

const OPEN = new Set(['Eyes', 'Brows', 'Mouth', 'More']);

export function buildPanel(names, presets, changed) {
  const rows = new Map();

  function show(weights) {
    for (const [name, weight] of Object.entries(weights)) {
      const row = rows.get(name);
      if (!row) continue;
      row.input.value = weight;
      row.output.textContent = Number(weight).toFixed(2);
      row.label.classList.toggle('moved', Math.abs(weight) > 0.004);
    }
  }

  function move(weights) {
    show(weights);
    changed(weights);
  }

  function slider(name) {
    const label = element('label', { className: 'slider' });
    const output = element('output', { textContent: '0.00' });
    const input = element('input', { type: 'range', min: 0, max: 1, step: 0.01, value: 0, name });
    label.append(element('span', { textContent: inWords(name), title: name }), input, output);
    input.addEventListener('input', () => {
      const other = byId('mirror').checked ? otherSide(name, names) : null;
      move({ [name]: Number(input.value), ...(other && { [other]: Number(input.value) }) });
    });
    rows.set(name, { label, input, output });
    return label;
  }

  for (const [region, members] of byRegion(names)) {
    const group = element('details', { open: OPEN.has(region) });
    const body = document.createElement('div');
    body.append(...members.map(slider));
    group.append(element('summary', { textContent: `${region} (${members.length})` }), body);
    byId('sliders').append(group);
  }

  const rest = () => Object.fromEntries(names.map((name) => [name, 0]));
  byId('reset').addEventListener('click', () => move(rest()));
  for (const [title, weights] of Object.entries(presets)) {
    if (!Object.keys(weights).every((name) => names.includes(name))) continue;
    const button = element('button', { type: 'button', textContent: inWords(title) });
    button.addEventListener('click', () => move({ ...rest(), ...weights }));
    byId('presets').append(button);
    byId('presets').hidden = false;
  }
  byId('find').addEventListener('input', (event) => find(event.target.value));
  byId('sliders').addEventListener('submit', (event) => event.preventDefault());

  function find(text) {
    const wanted = text.trim().toLowerCase();
    for (const [name, row] of rows) row.label.hidden = !`${name} ${inWords(name)}`.toLowerCase().includes(wanted);
    for (const group of byId('sliders').children) {
      group.hidden = !group.querySelector('.slider:not([hidden])');
      if (wanted && !group.hidden) group.open = true;
    }
  }

  return { show };
}

export function byId(id) {
  return document.getElementById(id);
}

function element(tag, properties) {
  return Object.assign(document.createElement(tag), properties);
}
