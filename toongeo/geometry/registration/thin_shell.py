"""A mesh that resists bending and stretching while landmarks and closest points draw it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.geometry.facing_surface import FACING, FacingSurface
from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.operators.factor import SpdFactor, factor_spd, solve
from toongeo.geometry.operators.vertex_normals import vertex_normals

__all__ = ["ThinShell"]

# With the landmarks' root mean square distance from their centre as the unit of length, at stiffness 1:
_BENDING, _STRETCHING = 1e-3, 1e-3
_STAY = 1e-6  # what nothing pulls, such as a loose part, stays where the similarity puts it
_SLIDING = 0.1  # weight of an error along the surface against one across it
_LEAST_REACH, _REACH = 0.02, 3.0  # distance at which a partner's pull fades: units, medians of the distances
_THINNED = (
    4  # a stiff shell has no need of more: every so many vertices look for a partner, but for the last two levels
)
_STEPS, _PRECISION = 8, 1e-3  # of the conjugate gradients in each iteration


class ThinShell:
    """The source as a thin shell that resists bending and stretching; all lengths in units."""

    def __init__(self, V: Floats, F: NDArray[np.int64], at: sp.csr_matrix, landmark_weight: Floats) -> None:
        self.V, self.F, self.at = V, F, at
        L = cotangent_laplacian(V, F, clamp=0.05)
        double = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1)
        area = np.bincount(F.ravel(), np.repeat(double / 6, 3), minlength=len(V))
        area = np.maximum(area, 1e-3 * area.mean())
        self.area = area
        self.energy = _BENDING * L @ sp.diags_array(1 / area) @ L + _STRETCHING * L
        self.stay = _STAY * sp.diags_array(area)
        self.pull = at.T @ sp.diags_array(landmark_weight)
        self.landmarks = self.pull @ at

    def laid_on(
        self, surface: FacingSurface, points: Floats, fitted: NDArray[np.bool_], levels: Floats, iterations: int
    ) -> tuple[Floats, float]:
        """Vertices (n, 3) laid on a surface, and the mean length of the last step."""
        stiff = levels[0] * self.energy + self.stay + self.landmarks
        X = self.V + solve(factor_spd(stiff), self.pull @ (points - self.at @ self.V))
        step = 0.0
        sought = np.flatnonzero(fitted)
        for number, level in enumerate(levels):
            stride = _THINNED if number < len(levels) - 2 else 1
            share = level / levels[0]  # in the end surfaces decide: two annotators do not mark quite the same points
            rest, smooth = X, level * self.energy + self.stay + share * self.landmarks
            mean_pull = (1 + 2 * _SLIDING) / 3
            factor = factor_spd(smooth + mean_pull * sp.diags_array(self.area * fitted))
            to_points = share * self.pull @ (points - self.at @ rest)
            for _ in range(iterations):
                before = X
                X = rest + self._displacement(surface, X, rest, sought[::stride], stride, smooth, factor, to_points)
                step = float(np.linalg.norm(X - before, axis=1).mean())
        return X, step

    def _displacement(
        self,
        surface: FacingSurface,
        X: Floats,
        rest: Floats,
        rows: NDArray[np.int64],
        stride: int,
        smooth: sp.csr_matrix,
        factor: SpdFactor,
        to_points: Floats,
    ) -> Floats:
        """Displacements (n, 3) from rest that bring the vertices ``rows``, now at X, nearer to their partners.

        They are every ``stride``-th, and speak for those between them.
        """
        seekers = X[rows]
        triangles, bary, cosines = surface.closest(seekers, vertex_normals(X, self.F)[rows])
        partners, normals = surface.points(triangles, bary), surface.normals_at(triangles, bary)
        facing = (cosines >= FACING) & ~surface.at_border(triangles, bary)
        distance = np.linalg.norm(partners - seekers, axis=1)
        reach = max(_LEAST_REACH, _REACH * float(np.median(distance[facing]))) if facing.any() else _LEAST_REACH
        weight = (stride * self.area[rows] * facing / (1 + (distance / reach) ** 2) ** 2)[:, None]  # Geman-McClure

        def drawn(d: Floats) -> Floats:
            across = normals * (normals * d).sum(1, keepdims=True)
            pulls = np.zeros_like(X)
            pulls[rows] = weight * (_SLIDING * d + (1 - _SLIDING) * across)
            return pulls

        def system(d: Floats) -> Floats:
            return np.asarray(smooth @ d) + drawn(d[rows])

        return _conjugate_gradients(system, to_points + drawn(partners - rest[rows]), X - rest, factor)


def _conjugate_gradients(system: Callable[[Floats], Floats], right: Floats, x: Floats, factor: SpdFactor) -> Floats:
    """A few preconditioned steps from x towards ``system(x) = right``."""
    residual = right - system(x)
    limit = _PRECISION**2 * float((right**2).sum())
    direction = np.zeros_like(x)
    last = 1.0
    for _ in range(_STEPS):
        if float((residual**2).sum()) <= limit:
            break
        z = solve(factor, residual)
        size = float((residual * z).sum())
        direction = z + size / last * direction
        image = system(direction)
        length = size / float((direction * image).sum())
        x = x + length * direction
        residual = residual - length * image
        last = size
    return x
