// Weights over a WebSocket of the computer itself. Messages that were applied are acknowledged by their number, some
// times a second, which is quicker than one by one.
const PAUSE = 15; // ms

export function listen(address, { apply, tell }) {
  const socket = new WebSocket(address);
  let applied = 0;
  function acknowledge() {
    if (socket.readyState === WebSocket.OPEN) socket.send(String(applied));
    applied = 0;
  }
  socket.addEventListener('open', () => tell('Live: waiting for weights'));
  socket.addEventListener('message', (event) => {
    apply(JSON.parse(event.data));
    if (applied === 0) setTimeout(acknowledge, PAUSE);
    applied += 1;
  });
  socket.addEventListener('message', () => tell('Live'), { once: true });
  socket.addEventListener('close', () => tell('Live: the connection is closed', true));
}
