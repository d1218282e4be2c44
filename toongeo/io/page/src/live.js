// Weights over a WebSocket of the computer itself. Messages that were applied are acknowledged by their number, some
// times a second, which is quicker than one by one.
const PAUSE = 15; // ms
const SEEN = 0.12; // per ms: weights that come faster cannot be seen one by one
const REST = 3;

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

// Calls `draw` for what has come since it last did: in every frame, unless weights come so fast that drawing would hold
// them up. Then, where a frame takes long (without a graphics card, half a second), it rests before the next.
export function paced(draw) {
  let came = 0;
  let busy = false;
  function frame() {
    busy = true;
    came = 0;
    draw();
    requestAnimationFrame((began) => requestAnimationFrame((done) => {
      const took = done - began;
      setTimeout(next, came > SEEN * took ? REST * took : 0);
    }));
  }
  function next() {
    busy = false;
    if (came) frame();
  }
  return () => {
    came += 1;
    if (!busy) frame();
  };
}
