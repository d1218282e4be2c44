"""Laplacian deformation with soft anchors, prefactored."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.deformation.anchored_mesh import (
    DEFAULT_WEIGHT,
    add_anchors,
    anchored_mesh,
    checked_rotations,
    checked_targets,
    turned_pull,
)
from toongeo.geometry.deformation.loose_parts import follow
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.geometry.validate_mesh import MeshLike, validate_vertices

__all__ = ["LaplacianAligner"]


class LaplacianAligner:
    """Move anchors of a mesh onto targets while it keeps its Laplacian coordinates; built once, used often.

    Minimises Eq. 9-10 of Pan et al. 2024,

    ``sum_i |L(v'_i) - L(v_i)|^2 + sum_a weight_a |v'_a - target_a|^2``,

    with ``L`` the uniform Laplacian of Eq. 9, or the same with clamped cotangent weights (each row divided
    by its diagonal, so that `weight` means the same). The result follows a rigid motion or a scale of mesh
    and targets together. Laplacian coordinates keep their directions in the world, so it does not follow
    a rotation of the targets alone, unless `align` is asked to estimate rotations.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Rest vertices, any unit.
    F : (m, 3) int, or None with a Trimesh
        Triangles; degenerate ones are allowed.
    anchors : (k,) int
        Vertex indices. An index may come twice; its targets must then agree, and its weights add.
    weight : float or (k,) float
        Lambda of Eq. 10: >= 0 (0: no effect), dimensionless. Every size is well conditioned. The residual of
        an anchor is some ``0.1 / weight`` of its displacement (0.3 on coarse meshes), that of an infinite
        weight exactly none. Default 1000.
    laplacian : {"uniform", "cotangent"}
    fixed : (n,) bool or (f,) int, optional
        Vertices that stay exactly where they are; none of them an anchor.
    loose : {"stay", "follow"}
        A component without an anchor stays where it is, or follows the rigid motion of the vertices that lie
        nearest to it in the components that have one or are fixed.

    Raises
    ------
    ValueError
        On a malformed mesh, anchors out of range or none, a weight that is negative, not a number or zero
        everywhere, fixed vertices out of range or among the anchors, or an unknown name.

    See Also
    --------
    laplacian_align : the same once, without the preparation for reuse.

    Notes
    -----
    With ``K = L^T L + S^T S`` (unit weights), ``Z = K^-1 S^T`` and ``G = S Z``, the minimiser for weights W
    is ``V + Z (I + (W - I) G)^-1 W (targets - S V)``: after one factorisation a call is a (k, k) and an
    (n, k) product. It holds for every W >= 0: a missing target is the weight 0, and a large W tends to
    interpolation without loss of digits. So the anchors may also be candidates, of which a call uses a few.

    Examples
    --------
    >>> import numpy as np
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    >>> aligner = LaplacianAligner(V, [[0, 1, 2], [2, 1, 3]], [0])
    >>> aligner.align([[0, 0, 5]])[3].round(9) + 0.0
    array([1., 1., 5.])
    """

    def __init__(
        self,
        V: MeshLike,
        F: ArrayLike | None,
        anchors: ArrayLike,
        *,
        weight: float | ArrayLike = DEFAULT_WEIGHT,
        laplacian: Literal["uniform", "cotangent"] = "uniform",
        fixed: ArrayLike | None = None,
        loose: Literal["stay", "follow"] = "stay",
    ) -> None:
        self._mesh = mesh = anchored_mesh(V, F, anchors, weight, laplacian, fixed, loose)
        a, n = len(mesh.anchors), len(mesh.V)
        unit = np.zeros((len(mesh.moving), a))
        unit[mesh.position, np.arange(a)] = 1.0
        self._factor = factor_spd(add_anchors(mesh, 1.0))
        Z = solve(self._factor, unit)
        self._G = Z[mesh.position]
        # Transposed, and with zeros for what stays: (3, a) @ (a, n) is the fastest form of the product.
        self._Zt = np.zeros((a, n))
        self._Zt[:, mesh.moving] = Z.T
        self._all_weights = mesh.total_weight(np.ones(len(mesh.given), bool))
        self._all_forces = self._forces(self._all_weights, np.eye(a))

    def align(self, targets: ArrayLike, V: ArrayLike | None = None, *, rotations: int = 0) -> NDArray[np.float64]:
        """Compute the deformed vertices.

        Parameters
        ----------
        targets : (k, 3) float
            Where the anchors go, in the order of `anchors`. A row with a NaN is a missing target: its anchor
            has no effect at all.
        V : (n, 3) float, optional
            Another rest shape of the same topology. Exact for the uniform Laplacian, which knows only the
            topology; cotangent weights stay those of the shape given at construction.
        rotations : int
            How often the rotation about each vertex is estimated anew and its Laplacian coordinate turned by
            it; each time costs a solution of the factored system.

        Returns
        -------
        (n, 3) float64

        Raises
        ------
        ValueError
            If `targets` is not (k, 3), has an infinite value or no row without NaN, if a repeated anchor has
            two different targets, if `V` does not fit, or `rotations` is not an integer >= 0.
        """
        mesh, rotations = self._mesh, checked_rotations(rotations)
        rest = mesh.V if V is None else self._checked_rest(V)
        pull, weight = mesh.pull(checked_targets(targets, len(mesh.given)), rest)
        with one_thread():
            complete = np.array_equal(weight, self._all_weights)
            forces = self._all_forces @ pull if complete else self._forces(weight, pull)
            displacement = forces.T @ self._Zt
        moved = np.add(rest, displacement.T, out=np.empty_like(rest))
        hard = np.isinf(weight)
        for _ in range(rotations):
            moved = self._turned(rest, moved, weight, pull)
        moved[mesh.anchors[hard]] = rest[mesh.anchors[hard]] + pull[hard]
        follow(mesh.loose, rest, moved)
        return moved

    __call__ = align

    def _checked_rest(self, V: ArrayLike) -> NDArray[np.float64]:
        V = validate_vertices(V)
        if V.shape != self._mesh.V.shape:
            raise ValueError(f"V: expected shape {self._mesh.V.shape} as at construction, got {V.shape}")
        return V

    def _turned(
        self,
        rest: NDArray[np.float64],
        moved: NDArray[np.float64],
        weight: NDArray[np.float64],
        pull: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """One more round: the minimiser for Laplacian coordinates turned as the surroundings have."""
        mesh = self._mesh
        # By superposition: what the turned coordinates do with unit weights on anchors that stay, and anchors that
        # pull from there. A component that lost its anchors must not float on the unit weights.
        free = solve(self._factor, turned_pull(mesh, rest, moved))
        lost = np.setdiff1d(mesh.component, mesh.component[weight > 0])
        turned = np.zeros_like(rest)
        turned[mesh.moving] = free
        turned[np.isin(mesh.parts, lost)] = 0.0
        drift = turned[mesh.anchors]
        with one_thread():
            forces = self._forces(weight, pull - drift, drift)
            return rest + turned + (forces.T @ self._Zt).T

    def _forces(
        self,
        weight: NDArray[np.float64],
        pull: NDArray[np.float64],
        drift: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64]:
        """``(I + (W - I) G)^-1 (W pull + drift)`` for (a, c) displacements."""
        # A component that lost all its anchors makes the matrix singular (there G 1 = 1): it gets no force.
        component = self._mesh.component
        held = np.isin(component, component[weight > 0])
        w, G = weight[held], self._G[np.ix_(held, held)]
        hard = np.isinf(w)
        w = np.where(hard, 1.0, w)
        scale = np.maximum(w, 1.0)  # rows divided by it have entries of order one for every weight
        unit = np.where(hard, 0.0, 1 / scale)  # 1 / scale in the limit, where w / scale is 1
        M = np.diag(unit) + (w / scale - unit)[:, None] * G
        right = (w / scale)[:, None] * pull[held]
        if drift is not None:
            right += unit[:, None] * drift[held]
        forces = np.zeros_like(pull)
        with one_thread():
            forces[held] = np.linalg.solve(M, right)
        return forces
