"""The inside of the mouth: a cavity that stays within the cheeks, and teeth and tongue that follow the lips
and the jaw."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from cage import Cage
from contacts import LIP_RIM, Opening, along, inner_lips, skin_walk
from scipy.sparse.linalg import splu
from source import Floats, Ints

_SEAL = (0.05, 1.5)  # mm by which the lips overlap behind their rims, and how far behind


class MouthInside:
    """Knows the rim where the lips meet, and carries deformations of the rim inside."""

    def __init__(self, cage: Cage) -> None:
        self.rim = cage.local(skin_walk(cage).loop(*LIP_RIM))
        self.cavity = cage.vertices_of("mouth_cavity")
        self.inner = np.union1d(self.cavity, inner_lips(cage))
        edges = cage.edges("mouth_cavity", "skin")
        n = len(cage.rest)
        links = sp.coo_matrix((np.ones(len(edges)), edges.T), shape=(n, n)).tocsr()
        links = links + links.T
        laplacian = (sp.diags(np.asarray(links.sum(1)).ravel()) - links).tocsc()
        self._to_rim = laplacian[self.inner][:, self.rim]
        # A little pull towards zero keeps the far end of the cavity at rest.
        system = laplacian[self.inner][:, self.inner] + 1e-3 * sp.identity(len(self.inner))
        self._solve = splu(system.tocsc())
        inside = np.zeros(n, dtype=bool)
        inside[self.inner] = True
        # Steps from the seam with the skin inwards.
        self.depth = _steps_from(
            links, np.intersect1d(self.cavity, cage.vertices_of("skin")), inside & (cage.part != 0)
        )
        touching = np.asarray((links[:, self.rim] @ np.ones(len(self.rim))) > 0).ravel()
        self.behind_rim = np.flatnonzero(touching & inside)
        self._partner = {
            int(v): int(self.rim[links[v][:, self.rim].toarray().ravel().argmax()]) for v in self.behind_rim
        }

    def sealed(self, mean: Floats, line: Opening) -> Floats:
        """The mean with the slit between the lips shut behind their rims, where nothing of the teeth should
        show."""
        out = mean.copy()
        upper = set(line.upper.tolist())
        low, high = mean[line.upper[0], 0], mean[line.upper[-1], 0]
        t = np.clip((mean[self.behind_rim, 0] - low) / (high - low), 0, 1)
        sides = along(line.t_upper, mean[line.upper], t), along(line.t_lower, mean[line.lower], t)
        middle = (sides[0] + sides[1])[:, 1] / 2
        out[self.behind_rim, 2] = np.minimum(mean[self.behind_rim, 2], np.minimum(*sides)[:, 2] - _SEAL[1])
        for v, y in zip(self.behind_rim.tolist(), middle, strict=True):
            if self._partner[v] in upper:
                out[v, 1] = min(out[v, 1], y - _SEAL[0])
            else:
                out[v, 1] = max(out[v, 1], y + _SEAL[0])
        return out

    def shrunk(self, mean: Floats) -> Floats:
        """The mean with a smaller cavity: the source's pierces the cheeks of narrow faces."""
        out = mean.copy()
        blend = np.clip(self.depth / 3, 0, 1)[self.cavity, None]
        centre = np.array([0.0, mean[self.cavity, 1].mean(), 0.0])
        small = (mean[self.cavity] - centre) * [0.72, 0.8, 1.0] + centre
        out[self.cavity] = (1 - blend) * mean[self.cavity] + blend * small
        return out

    def extended(self, delta: Floats) -> Floats:
        """Copy of displacements (n, 3) whose part inside the mouth is the harmonic extension of those of the
        rim."""
        out = delta.copy()
        out[self.inner] = -self._solve.solve(self._to_rim @ delta[self.rim])
        return out

    def carried(self, delta: Floats, mean: Floats, points: Floats) -> Floats:
        """Displacements of `points` (teeth, tongue) behind lips that move by `delta` (n, 3) from `mean`: the
        mean translation of the rim, and its change of width."""
        x = mean[self.rim, 0]
        widening = (delta[self.rim, 0] @ x) / (x @ x)
        return delta[self.rim].mean(0) + points * [widening, 0.0, 0.0]


def rigid_motion(points: Floats, moved: Floats) -> tuple[Floats, Floats]:
    """Rotation (3, 3) and translation (3,) that bring `points` (k, 3) closest to `moved` in the least-squares
    sense."""
    centre, moved_centre = points.mean(0), moved.mean(0)
    u, _, vt = np.linalg.svd((points - centre).T @ (moved - moved_centre))
    vt[2] *= np.sign(np.linalg.det(u @ vt))
    rotation = (u @ vt).T
    return rotation, moved_centre - rotation @ centre


def _steps_from(links: sp.csr_matrix, seed: Ints, within: np.ndarray) -> Floats:
    """Number of edges from the seed vertices to those `within` (n,) a mask, 0 where not reached."""
    depth = np.zeros(links.shape[0])
    front = np.zeros(links.shape[0], dtype=bool)
    front[seed] = True
    seen, steps = front.copy(), 0
    while front.any():
        front = (links @ front.astype(float) > 0) & ~seen & within
        steps += 1
        depth[front] = steps
        seen |= front
    return depth
