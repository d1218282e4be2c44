// Whom the editor asks: a server on this computer, or the kernel of a notebook.
export function httpBackend(token) {
  const headers = { Authorization: `Bearer ${token}` };
  async function got(address, options) {
    let response;
    try {
      response = await fetch(address, { ...options, cache: 'no-store' });
    } catch {
      throw new Error("This page's program has ended: start it again");
    }
    if (!response.ok) throw new Error(await response.text());
    return response;
  }
  return {
    async ask(question, message = {}) {
      const body = JSON.stringify(message);
      const response = await got(`/ask/${question}`, { method: 'POST', headers: { ...headers, 'Content-Type': 'application/json' }, body });
      return response.json();
    },
    async picture(number) {
      return (await got(`/picture/${number}`, { headers })).blob();
    },
  };
}

export function widgetBackend(model) {
  const waiting = new Map();
  let count = 0;
  model.on('msg:custom', (reply, buffers) => {
    const { resolve, reject } = waiting.get(reply.id) ?? {};
    waiting.delete(reply.id);
    if (!resolve) return;
    if (reply.error) reject(new Error(reply.error));
    else resolve(buffers?.length ? new Blob([buffers[0]], { type: 'image/jpeg' }) : reply.answer);
  });
  function ask(question, message = {}) {
    count += 1;
    const id = count;
    const answer = new Promise((resolve, reject) => waiting.set(id, { resolve, reject }));
    model.send({ id, question, message });
    return answer;
  }
  return { ask, picture: (number) => ask('picture', { picture: number }) };
}

// Calls `act` with the newest argument, one call at a time: what comes while it is busy replaces what waits.
export function newest(act) {
  let busy = false;
  let next = null;
  return async function call(argument) {
    next = { argument };
    if (busy) return;
    busy = true;
    while (next) {
      const { argument: current } = next;
      next = null;
      await act(current);
    }
    busy = false;
  };
}
