"""Laplacian deformation with soft anchors, once."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.deformation.anchored_mesh import (
    DEFAULT_WEIGHT,
    AnchoredMesh,
    add_anchors,
    anchored_mesh,
    checked_rotations,
    checked_targets,
    turned_pull,
)
from toongeo.geometry.deformation.loose_parts import follow
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.geometry.validate_mesh import MeshLike, validate_mesh

__all__ = ["laplacian_align"]


def laplacian_align(
    V: MeshLike,
    F: ArrayLike | None,
    anchors: ArrayLike,
    targets: ArrayLike,
    *,
    weight: float | ArrayLike = DEFAULT_WEIGHT,
    laplacian: Literal["uniform", "cotangent"] = "uniform",
    fixed: ArrayLike | None = None,
    loose: Literal["stay", "follow"] = "stay",
    rotations: int = 0,
) -> NDArray[np.float64]:
    """Move anchors of a mesh onto targets while the mesh keeps its Laplacian coordinates.

    Minimises ``sum_i |L(v'_i) - L(v_i)|^2 + sum_a weight_a |v'_a - target_a|^2`` (Pan et al. 2024, Eq. 9-10).
    Laplacian coordinates keep their directions in the world, so that a part that turns is sheared; with `rotations`
    they turn along with their surroundings. It factors the system anew. For the same topology and anchors again and
    again, keep a `LaplacianAligner`.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Rest vertices, any unit.
    F : (m, 3) int, or None with a Trimesh
        Triangles; degenerate ones are allowed.
    anchors : (k,) int
        Vertex indices. An index may come twice if its targets agree.
    targets : (k, 3) float
        Where the anchors go. A row with a NaN is missing and has no effect.
    weight : float or (k,) float
        Lambda of Eq. 10, one or one an anchor: >= 0, dimensionless; infinity meets the target exactly.
    laplacian : {"uniform", "cotangent"}
    fixed : (n,) bool or (f,) int, optional
        Vertices that stay exactly where they are; none of them an anchor.
    loose : {"stay", "follow"}
        A component without an anchor stays where it is, or follows the rigid motion of the vertices that lie nearest
        to it in the components that have one or are fixed.
    rotations : int
        How often the rotation about each vertex is estimated anew and its Laplacian coordinate turned by it. Five
        settle a bar that is bent by a right angle.

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
    rotations = checked_rotations(rotations)
    V, F = validate_mesh(V, F)
    mesh = anchored_mesh(V, F, anchors, weight, laplacian, fixed, loose)
    targets = checked_targets(targets, len(mesh.given))
    pull, weights = mesh.pull(targets, mesh.V)
    if (weights == 0).any():
        # Without its missing anchors: a component that loses all of them must leave the system.
        some = np.isfinite(targets).all(axis=1) & (mesh.weight > 0)
        mesh = anchored_mesh(mesh.V, F, mesh.given[some], mesh.weight[some], laplacian, fixed, loose)
        pull, weights = mesh.pull(targets[some], mesh.V)
    moved = _solved(mesh, pull, weights, rotations)
    follow(mesh.loose, mesh.V, moved)
    return moved


def _solved(
    mesh: AnchoredMesh, pull: NDArray[np.float64], weights: NDArray[np.float64], rotations: int
) -> NDArray[np.float64]:
    """Vertices (n, 3) that minimise Eq. 10, hard anchors put where they belong and left out of the system."""
    hard = np.isinf(weights)
    free = np.setdiff1d(np.arange(len(mesh.moving)), mesh.position[hard])
    # (L^T L + S^T W S) (v' - v) = S^T W (p - S v), the normal equations of Eq. 10
    K = add_anchors(mesh, np.where(hard, 0.0, weights))
    displacement, force = np.zeros((2, len(mesh.moving), 3))
    displacement[mesh.position[hard]] = pull[hard]
    force[mesh.position[~hard]] = weights[~hard, None] * pull[~hard]
    if hard.any():
        force -= K @ displacement
        K = K[free][:, free]
    factor = factor_spd(K) if len(free) else None
    moved = mesh.V.copy()
    for round_ in range(rotations + 1):
        turn = turned_pull(mesh, mesh.V, moved) if round_ else 0.0
        if factor:
            displacement[free] = solve(factor, (force + turn)[free])
        moved[mesh.moving] = mesh.V[mesh.moving] + displacement
    moved[mesh.anchors[hard]] = mesh.V[mesh.anchors[hard]] + pull[hard]
    return moved
