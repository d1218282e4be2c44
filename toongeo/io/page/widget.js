// The page of an avatar in a notebook (anywidget): weights go to it and come from it by messages.
function render({ model, el }) {
  const { page, height } = model.get('settings');
  const frame = document.createElement('iframe');
  frame.title = 'Avatar';
  frame.sandbox = 'allow-scripts allow-downloads';
  frame.style = `width: 100%; height: ${height}px; border: 0`;
  frame.srcdoc = page;
  let told = ''; // what the page knows already
  function tell() {
    const weights = model.get('weights');
    if (JSON.stringify(weights) === told) return;
    told = JSON.stringify(weights);
    frame.contentWindow?.postMessage({ toongeo: weights }, '*');
  }
  function hear(event) {
    if (event.source !== frame.contentWindow || !event.data?.toongeo) return;
    if (event.data.toongeo === 'ready') {
      told = '';
      tell();
      return;
    }
    told = JSON.stringify(event.data.toongeo);
    model.set('weights', event.data.toongeo);
    model.save_changes();
  }
  window.addEventListener('message', hear);
  model.on('change:weights', tell);
  el.append(frame);
  return () => {
    window.removeEventListener('message', hear);
    model.off('change:weights', tell);
  };
}

export default { render };
