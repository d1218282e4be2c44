// Which vertices the landmarks have. A state is never changed: each step makes a new one.
export function emptyState(count) {
  return { vertices: Array(count).fill(null), proposed: Array(count).fill(false) };
}

export function started(vertices) {
  return { vertices: [...vertices], proposed: vertices.map(() => false) };
}

// A state in which a point has a vertex; that of the other side is proposed, unless a person has picked it.
export function put(from, point, vertex, twins, partners) {
  const next = { vertices: [...from.vertices], proposed: [...from.proposed] };
  next.vertices[point] = vertex;
  next.proposed[point] = false;
  const twin = twins[point];
  if (partners && twin !== point && (next.vertices[twin] === null || next.proposed[twin])) {
    next.vertices[twin] = partners[vertex];
    next.proposed[twin] = true;
  }
  return next;
}

// A state in which a point has none; what was proposed because of it goes too.
export function removed(from, point, twins) {
  const next = { vertices: [...from.vertices], proposed: [...from.proposed] };
  for (const k of [point, twins[point]]) {
    if (k !== point && !next.proposed[k]) continue;
    next.vertices[k] = null;
    next.proposed[k] = false;
  }
  return next;
}

// The next point in the order of asking that has no vertex; the point itself if all have one.
export function nextToPick({ vertices }, order, point) {
  const at = order.indexOf(point);
  const after = [...order.slice(at + 1), ...order.slice(0, at)];
  return after.find((k) => vertices[k] === null) ?? point;
}

export function counts({ vertices, proposed }) {
  const picked = vertices.filter((vertex, k) => vertex !== null && !proposed[k]).length;
  const guessed = proposed.filter(Boolean).length;
  return { picked, guessed, left: vertices.length - picked - guessed };
}
