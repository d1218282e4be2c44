// Pictures: which there are, which is shown, whether its points are saved.
import { newest } from './backend.js';
import { known, state } from './landmarks.js';
import { make } from './panel.js';

const SMALL = 0.45; // of the picture: a face that is smaller is shown larger
const AROUND = 0.35; // of the face's size: what is shown around it then

export class Files {
  constructor(editor, parts, backend) {
    this.editor = editor;
    this.parts = parts;
    this.backend = backend;
    this.list = [];
    this.current = 0;
    this.bitmap = null;
    parts.format.append(...editor.settings.formats.map((suffix) => make('option', { value: suffix }, suffix)));
    this.keep = newest(() => this.save(true));
    if (editor.settings.isWidget) return;
    window.addEventListener('beforeunload', (event) => {
      if (this.isOpen && !editor.history.isSaved) event.preventDefault();
    });
  }

  async start() {
    const answer = await this.editor.ask('list', {});
    if (!answer) return;
    this.list = answer.pictures;
    const first = this.list.findIndex((picture) => !picture.done);
    await Promise.all([this.open(Math.max(first, 0)), this.editor.refit.load().catch((error) => this.editor.say(error.message, true))]);
    this.editor.changed(true);
    this.parts.picture.dataset.ready = 'true';
  }

  async open(k) {
    const { editor } = this;
    this.current = k;
    this.isOpen = false;
    editor.say('Looking for the face…');
    try {
      const [answer, blob] = await Promise.all([this.backend.ask('open', { picture: k }), this.backend.picture(k)]);
      this.bitmap = await createImageBitmap(blob);
      this.size = [answer.width, answer.height];
      this.isOpen = true;
      editor.refit.picture(this.bitmap, ...this.size);
      editor.view.show(...this.size);
      this.addFormat(answer.suffix);
      editor.open(state(answer.points, answer.missing, answer.confidence), answer.source === 'file');
      this.look(answer);
      if (answer.source === 'detected') editor.kept();
    } catch (error) {
      this.bitmap = null;
      editor.open(editor.history.state, true);
      editor.say(error.message, true);
    }
  }

  look(answer) {
    const { editor } = this;
    if (answer.source === 'mean') editor.placing.begin();
    else this.frame(answer.points);
    const texts = { file: 'Points were read from a file', detected: 'A face was found: look at the orange points first', mean: editor.settings.detector ? 'No face was found: place it by clicks' : '' };
    editor.say(answer.note || texts[answer.source], Boolean(answer.note));
  }

  // A small face is shown larger.
  frame(points) {
    const low = [0, 1].map((axis) => Math.min(...points.map((point) => point[axis])));
    const high = [0, 1].map((axis) => Math.max(...points.map((point) => point[axis])));
    const side = Math.max(high[0] - low[0], high[1] - low[1]);
    if (side > SMALL * Math.max(...this.size)) return;
    this.editor.view.frame(low.map((value) => value - AROUND * side), high.map((value) => value + AROUND * side));
  }

  addFormat(suffix) {
    const { format } = this.parts;
    if (![...format.options].some((option) => option.value === suffix)) format.append(make('option', { value: suffix }, suffix));
    format.value = suffix;
  }

  tell() {
    const { parts, list, editor } = this;
    if (!list.length) return;
    const done = list.filter((picture) => picture.done).length;
    const several = list.length > 1 ? [make('span', {}, `${this.current + 1}/${list.length} · `), make('span', { class: 'wide' }, `${done} done · `)] : [];
    parts.name.textContent = list[this.current].name;
    const state = editor.history.isSaved ? (list[this.current].done ? 'saved' : 'no points yet') : 'not saved';
    parts.count.replaceChildren(...several, state);
    parts.count.classList.toggle('unsaved', !editor.history.isSaved);
    parts.previous.hidden = parts.next.hidden = list.length < 2;
    parts.previous.disabled = this.current === 0;
    parts.next.disabled = this.current === list.length - 1;
    if (!editor.settings.isWidget) document.title = `${editor.history.isSaved ? '' : '• '}${list[this.current].name}`;
  }

  paint(view) {
    const { canvas } = this.parts;
    const [width, height] = view.seen;
    const ratio = Math.min(devicePixelRatio, 2);
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const context = canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    if (!this.bitmap) return;
    context.imageSmoothingEnabled = view.scale < 8; // near by, pixels are pixels
    context.imageSmoothingQuality = 'high';
    context.drawImage(this.bitmap, ...view.shift, view.scale * this.size[0], view.scale * this.size[1]);
  }

  async save(replace = false) {
    const { editor } = this;
    if (!this.isOpen) return false;
    if (editor.isPlacing && !editor.settings.isWidget) editor.endPlacing(true);
    const saved = editor.history.at;
    const message = { picture: this.current, points: known(editor.history.state), suffix: this.parts.format.value, replace };
    const answer = await editor.ask('save', message);
    if (!answer) return false;
    if (answer.exists) {
      const choice = await editor.question(`${answer.exists} is there already. Replace it?`, ['Replace', 'Cancel']);
      return choice === 0 ? this.save(true) : false;
    }
    if (editor.history.at === saved) editor.history.markSaved();
    this.list[this.current].done = true;
    this.tell();
    if (!editor.settings.isWidget) editor.say(`Saved ${answer.file}`);
    return true;
  }

  async go(by) {
    const { editor } = this;
    const to = this.current + by;
    if (to < 0 || to >= this.list.length) return;
    if (!editor.history.isSaved && editor.history.at > 0) {
      const choice = await editor.question('The points of this picture are not saved.', ['Save and go on', 'Discard', 'Stay']);
      if (choice === 2 || choice === -1 || (choice === 0 && !(await this.save()))) return;
    }
    if (editor.isPlacing) editor.endPlacing(false);
    await this.open(to);
  }

  async detect() {
    const { editor } = this;
    if (!this.isOpen) return;
    if (editor.isPlacing) editor.endPlacing(false);
    const asked = this.current;
    editor.say('Looking for the face…');
    const answer = await editor.ask('detect', { picture: asked });
    if (!answer || asked !== this.current) return;
    if (!answer.points) {
      editor.say('No face was found: place it by clicks', true);
      return;
    }
    editor.preview(state(answer.points, null, answer.confidence));
    editor.commit();
    editor.say('A face was found: look at the orange points first');
  }
}
