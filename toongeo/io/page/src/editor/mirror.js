// The other side of the face: the affine map that best takes each point to its twin, for heads that are turned, too.
export function mirrorMap(points, missing, twins) {
  const pairs = points.map((_, k) => k).filter((k) => !missing[k] && !missing[twins[k]]);
  // Normal equations of x' = a x + b y + c, and of y' alike.
  const N = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  const right = [[0, 0, 0], [0, 0, 0]];
  const middle = [0, 1].map((axis) => pairs.reduce((sum, k) => sum + points[k][axis], 0) / (pairs.length || 1));
  for (const k of pairs) {
    const from = [points[k][0] - middle[0], points[k][1] - middle[1], 1];
    const to = points[twins[k]];
    for (let i = 0; i < 3; i++) {
      for (let j = 0; j < 3; j++) N[i][j] += from[i] * from[j];
      right[0][i] += from[i] * to[0];
      right[1][i] += from[i] * to[1];
    }
  }
  const X = solved(N, right[0]);
  const Y = solved(N, right[1]);
  if (!X || !Y) return null;
  return {
    place: ([x, y]) => [X, Y].map(([a, b, c]) => a * (x - middle[0]) + b * (y - middle[1]) + c),
    move: ([dx, dy]) => [X, Y].map(([a, b]) => a * dx + b * dy),
  };
}

// Cramer's rule; null if the points lie on a line.
function solved(N, b) {
  const det = determinant(N);
  if (Math.abs(det) < 1e-9 * N[0][0] * N[1][1] * N[2][2] || !det) return null;
  return [0, 1, 2].map((j) => determinant(N.map((row, i) => row.map((value, k) => (k === j ? b[i] : value)))) / det);
}

function determinant([[a, b, c], [d, e, f], [g, h, i]]) {
  return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
}
