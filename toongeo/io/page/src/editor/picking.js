// Which points are meant by a place or a box on the screen.
const LINE = 7; // CSS px within which a line is hit

// The nearest point, or a point of the nearest line, at CSS pixels; null if nothing is near.
export function pick(at, radius, places, missing, lines) {
  const away = ([x, y]) => Math.hypot(x - at[0], y - at[1]);
  const point = places.reduce((best, place, k) => (away(place) < away(places[best]) ? k : best), 0);
  if (away(places[point]) <= radius) return { point, isLine: false };
  for (const { first, last, closed } of lines) {
    for (let k = first; k <= last; k++) {
      const next = k < last ? k + 1 : closed ? first : k;
      if (!missing[k] && !missing[next] && distance(at, places[k], places[next]) <= LINE) return { point: k, isLine: true };
    }
  }
  return null;
}

export function inBox([[x, y], [u, v]], places) {
  const within = (value, a, b) => value >= Math.min(a, b) && value <= Math.max(a, b);
  return places.flatMap(([px, py], k) => (within(px, x, u) && within(py, y, v) ? [k] : []));
}

// From a place to a stretch of a line.
function distance([x, y], [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const along = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}
