// The landmark editor or the picker as a page, the editor and as a widget of a notebook (the default export is what anywidget asks for).
import { httpBackend, widgetBackend } from './backend.js';
import { Picker, scriptedPicker } from '../picker/picker.js';
import { Editor } from './editor.js';
import { scripted } from './scripted.js';

const settings = document.getElementById('editor-settings');
if (settings) {
  const known = JSON.parse(settings.textContent);
  const root = document.getElementById('editor');
  if (known.kind === 'picker') {
    const picker = new Picker(root, known, httpBackend(known.token));
    window.toongeo = scriptedPicker(picker);
    picker.start();
  } else {
    const editor = new Editor(root, known, httpBackend(known.token));
    window.toongeo = scripted(editor);
    editor.start();
  }
}

export default {
  render({ model, el }) {
    const root = document.createElement('div');
    root.className = 'toongeo-editor toongeo-widget';
    root.dataset.lmSuppressShortcuts = 'true'; // those of JupyterLab
    el.append(root);
    const editor = new Editor(root, model.get('settings'), widgetBackend(model));
    editor.start();
    return () => editor.end();
  },
};
