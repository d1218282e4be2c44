// Questions and help, in one dialog.
import { make } from './panel.js';

// Which answer was given: its index, or -1 if the dialog was closed.
export function question(parts, text, answers) {
  parts.words.replaceChildren(make('p', {}, text));
  return opened(parts, 'Question', answers);
}

export function help(parts, rows) {
  const list = make('dl', {});
  for (const [keys, what] of rows) list.append(make('dt', {}, keys), make('dd', {}, what));
  parts.words.replaceChildren(make('h2', {}, 'Keys and gestures'), list);
  return opened(parts, 'Keys and gestures', ['Close']);
}

function opened(parts, label, answers) {
  const { dialog } = parts;
  dialog.setAttribute('aria-label', label);
  dialog.returnValue = '';
  parts.answers.replaceChildren(...answers.map((text, k) => make('button', { value: String(k), class: k === 0 ? 'main' : '' }, text)));
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener('close', () => resolve(dialog.returnValue === '' ? -1 : Number(dialog.returnValue)), { once: true });
  });
}
