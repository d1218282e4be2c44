// Soft drags: neighbours follow as the Gaussian process of the alignment's flow has it (symmetric_field.py), here in the
// plane of the picture, for each side by itself and without its affine part, which would take the whole face along.

// Covariance (2 x 2, by rows) of the displacements of two points that lie `r` apart, in units of the outer-eye distance.
function covariance([rx, ry], { reach, growth }) {
  const a = Math.sqrt(3) / reach;
  const scaled = a * Math.hypot(rx, ry);
  const fade = Math.exp(-scaled);
  const same = (1 + scaled) * fade;
  const along = -growth * a * a * fade;
  return [same + along * rx * rx, along * rx * ry, along * rx * ry, same + along * ry * ry];
}

function covariances(rows, columns, unit, prior) {
  const matrix = rows.flatMap(() => [new Float64Array(2 * columns.length), new Float64Array(2 * columns.length)]);
  rows.forEach(([x, y], i) => columns.forEach(([u, v], j) => {
    const [xx, xy, yx, yy] = covariance([(x - u) / unit, (y - v) / unit], prior);
    matrix[2 * i][2 * j] = xx;
    matrix[2 * i][2 * j + 1] = xy;
    matrix[2 * i + 1][2 * j] = yx;
    matrix[2 * i + 1][2 * j + 1] = yy;
  }));
  return matrix;
}

// How others follow held points: a function from the displacements of the held ones to those of the others.
export function followers(others, held, unit, prior) {
  const solve = cholesky(covariances(held, held, unit, prior), prior.noise);
  const across = covariances(others, held, unit, prior);
  return (displacements) => {
    const forces = solve(displacements.flat());
    const along = (row) => row.reduce((sum, value, j) => sum + value * forces[j], 0);
    return others.map((_, i) => [along(across[2 * i]), along(across[2 * i + 1])]);
  };
}

// Solver of (A + noise I) x = b for a covariance A.
function cholesky(A, noise) {
  const n = A.length;
  const L = A.map((row) => Float64Array.from(row));
  for (let i = 0; i < n; i++) {
    for (let j = 0; j <= i; j++) {
      let sum = A[i][j] + (i === j ? noise : 0);
      for (let k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
      L[i][j] = i === j ? Math.sqrt(sum) : sum / L[j][j];
    }
  }
  return (b) => {
    const x = Float64Array.from(b);
    for (let i = 0; i < n; i++) {
      for (let k = 0; k < i; k++) x[i] -= L[i][k] * x[k];
      x[i] /= L[i][i];
    }
    for (let i = n - 1; i >= 0; i--) {
      for (let k = i + 1; k < n; k++) x[i] -= L[k][i] * x[k];
      x[i] /= L[i][i];
    }
    return x;
  };
}
