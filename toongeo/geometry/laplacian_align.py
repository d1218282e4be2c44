"""Laplacian deformation with soft anchors, once."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry._anchored_mesh import DEFAULT_WEIGHT, add_anchors, anchored_mesh, checked_targets
from toongeo.geometry._factor import factor_spd, solve

__all__ = ["laplacian_align"]


def laplacian_align(
    V: ArrayLike,
    F: ArrayLike,
    anchors: ArrayLike,
    targets: ArrayLike,
    *,
    weight: float | ArrayLike = DEFAULT_WEIGHT,
    laplacian: Literal["uniform", "cotangent"] = "uniform",
) -> NDArray[np.float64]:
    """Move anchors of a mesh onto targets while the mesh keeps its Laplacian coordinates.

    Minimises ``sum_i |L(v'_i) - L(v_i)|^2 + sum_a weight_a |v'_a - target_a|^2`` (Pan et al. 2024, Eq. 9-10).
    It factors the system anew. For the same topology and anchors again and again, keep a `LaplacianAligner`.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, any unit.
    F : (m, 3) int
        Triangles. Degenerate ones are allowed; a component without an anchor stays where it is.
    anchors : (k,) int
        Vertex indices. An index may come twice if its targets agree.
    targets : (k, 3) float
        Where the anchors go. A row with a NaN is missing and has no effect.
    weight : float or (k,) float
        Lambda of Eq. 10, one or one an anchor: finite, >= 0, dimensionless.
    laplacian : {"uniform", "cotangent"}

    Returns
    -------
    (n, 3) float64
        The deformed vertices.

    Raises
    ------
    ValueError
        As `LaplacianAligner` and its `align`.

    Examples
    --------
    >>> import numpy as np
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    >>> F = [[0, 1, 2], [2, 1, 3]]
    >>> laplacian_align(V, F, [0, 3], [[0, 0, 1], [1, 1, 1]])[1].round(9) + 0.0
    array([1., 0., 1.])
    """
    mesh = anchored_mesh(V, F, anchors, weight, laplacian)
    targets = checked_targets(targets, len(mesh.given))
    pull, weights = mesh.pull(targets, mesh.V)
    if (weights == 0).any():
        # Without its missing anchors: a component that loses all of them must leave the system.
        some = np.isfinite(targets).all(axis=1) & (mesh.weight > 0)
        return laplacian_align(
            mesh.V, F, mesh.given[some], targets[some], weight=mesh.weight[some], laplacian=laplacian
        )
    force = np.zeros((len(mesh.moving), 3))
    force[mesh.position] = weights[:, None] * pull
    moved = mesh.V.copy()
    # (L^T L + S^T W S) (v' - v) = S^T W (p - S v), the normal equations of Eq. 10
    moved[mesh.moving] += solve(factor_spd(add_anchors(mesh, weights)), force)
    return moved
