// The landmark editor as a page, and as a widget of a notebook (the default export is what anywidget asks for).
import { httpBackend, widgetBackend } from './backend.js';
import { Editor } from './editor.js';
import { scripted } from './scripted.js';

const settings = document.getElementById('editor-settings');
if (settings) {
  const known = JSON.parse(settings.textContent);
  const editor = new Editor(document.getElementById('editor'), known, httpBackend(known.token));
  window.toongeo = scripted(editor);
  editor.start();
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
