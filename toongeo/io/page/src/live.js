// Weights over a WebSocket of the computer itself; each message that was applied is acknowledged.
export function listen(address, names, { apply, tell }) {
  const socket = new WebSocket(address);
  let applied = 0;
  socket.addEventListener('open', () => tell('Live: waiting for weights'));
  socket.addEventListener('message', (event) => {
    apply(JSON.parse(event.data));
    applied += 1;
    if (applied === 1) tell('Live');
    socket.send('1');
  });
  socket.addEventListener('close', () => tell('Live: the connection is closed', true));
}
