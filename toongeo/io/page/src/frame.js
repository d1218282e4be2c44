// Weights to and from the notebook around a page that stands in a frame; nobody else is heard.
export function converse(apply) {
  window.addEventListener('message', (event) => {
    if (event.source === window.parent && event.data?.toongeo) apply(event.data.toongeo);
  });
  window.parent.postMessage({ toongeo: 'ready' }, '*');
  return (weights) => window.parent.postMessage({ toongeo: weights }, '*');
}
