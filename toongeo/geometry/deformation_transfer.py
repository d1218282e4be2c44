"""Deformation transfer between two meshes of one topology."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.deformation.transfer_operators import transfer_operators
from toongeo.geometry.operators.components import components
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.geometry.rotations.rigid_rotation import rigid_rotation
from toongeo.geometry.source_motion import SourceMotion, source_motion
from toongeo.geometry.validate_mesh import MeshLike, validate_like, validate_mesh

__all__ = ["DeformationTransfer", "deformation_transfer"]


def deformation_transfer(
    V_source: MeshLike,
    V_deformed: MeshLike,
    F: ArrayLike | None,
    V_target: MeshLike,
    *,
    pinned: ArrayLike | None = None,
    align: bool = False,
) -> NDArray[np.float64]:
    """Deform `V_target` as `V_deformed` deforms `V_source` (Pan et al. 2024, Eq. 14-16).

    Parameters
    ----------
    V_source : (n, 3) float, or trimesh.Trimesh
        The source at rest.
    V_deformed : (n, 3) or (k, n, 3) float, or trimesh.Trimesh
        The source deformed, once or k times.
    F : (m, 3) int, or None if `V_source` is a Trimesh
        Triangles of all of them.
    V_target : (n, 3) float, or trimesh.Trimesh
        The target at rest.
    pinned : (p,) int, optional
        Vertices held where the target has them; see `DeformationTransfer`.
    align : bool
        Turn the source with its deformations onto the target first; see `DeformationTransfer`.

    Returns
    -------
    float64 of the shape of `V_deformed`
        The target deformed.

    Raises
    ------
    ValueError
        As `DeformationTransfer` and its `transfer`.

    Examples
    --------
    >>> import numpy as np
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> deformation_transfer(V, 2 * V, F, V + 5)[1].round(9)
    array([7., 5., 5.])
    """
    return DeformationTransfer(V_source, F, V_target, pinned=pinned, align=align).transfer(V_deformed)


class DeformationTransfer:
    """Sumner and Popovic's deformation transfer with the target's system factored once.

    Every triangle, with a fourth vertex ``v4 = v1 + n / sqrt|n|`` along its normal (Eq. 14 of Pan et al.
    2024), is mapped by an affine ``Q_j`` from the source at rest to the source deformed (Eq. 15). The
    target's vertices minimise ``sum_j |Q_j - Q'_j|_F^2`` (Eq. 16, squared as Sumner and Popovic have it,
    each triangle alike whatever its area; but slivers, of sines below 0.001, count less by the square of it: their
    gradients are next to unknown, and would throw their corners far away). The target's fourth vertices occur in one
    term each and are eliminated; what remains has the same minimiser and a third of the unknowns.

    The gradients are those of the world's axes: they are carried over as they are, so source and target have to face
    the same way. ``align=True`` sees to that; a rigid motion of one of the meshes then only moves the result along.

    The energy does not see translations. A connected component with a pinned vertex is held by it. One
    without is placed so that its lowest-numbered vertex moves as far as that vertex of the source does;
    another vertex instead would only shift the component as a whole.

    Parameters
    ----------
    V_source : (n, 3) float, or trimesh.Trimesh
        The source at rest, without degenerate triangles.
    F : (m, 3) int, or None if `V_source` is a Trimesh
        Triangles of source and target.
    V_target : (n, 3) float, or trimesh.Trimesh
        The target at rest, without degenerate triangles: they have no gradient.
    pinned : (p,) int, optional
        Vertices held exactly where the target has them, in every transfer.
    align : bool
        Turn the source at rest, and all its deformations with it, by the rotation that brings it nearest to the
        target (Kabsch). False is the method as published.
    weights : {"uniform", "area"}
        Of the triangles in the energy. The paper counts them alike, so that where a mesh is fine it is stiff; by area
        the result depends on the surfaces alone, which matters where source and target mesh differ much in density.

    Raises
    ------
    ValueError
        On malformed or degenerate meshes, different vertex counts or triangles, or pins out of range.

    References
    ----------
    R. W. Sumner, J. Popovic, "Deformation transfer for triangle meshes", ACM TOG 23(3), 2004.

    Examples
    --------
    >>> import numpy as np
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> transfer = DeformationTransfer(V, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], 3 * V, pinned=[0])
    >>> transfer.transfer(2 * V)[1].round(9)
    array([6., 0., 0.])
    """

    def __init__(
        self,
        V_source: MeshLike,
        F: ArrayLike | None,
        V_target: MeshLike,
        *,
        pinned: ArrayLike | None = None,
        align: bool = False,
        weights: Literal["uniform", "area"] = "uniform",
    ) -> None:
        if weights not in ("uniform", "area"):
            raise ValueError(f"weights: expected 'uniform' or 'area', got {weights!r}")
        self._source, faces = validate_mesh(V_source, F, names=("V_source", "F"), nondegenerate=True)
        V_target = validate_like(V_target, faces, name="V_target", like="V_source")
        self._target, faces = validate_mesh(V_target, faces, names=("V_target", "F"), nondegenerate=True)
        n = len(self._source)
        if len(self._target) != n:
            raise ValueError(f"V_target: expected {n} vertices as V_source has, got {len(self._target)}")
        self._corners = np.ascontiguousarray(faces.T)
        self._rotation = rigid_rotation(self._source, self._target) if align else np.eye(3)

        turned = self._source @ self._rotation.T
        stiffness, from_vertices, from_normals = transfer_operators(
            turned, self._target, self._corners, by_area=weights == "area"
        )
        pins = _checked_pins(pinned, n)
        self._component = components(faces, n)
        lowest = np.unique(self._component, return_index=True)[1]
        self._n_components = len(lowest)
        self._placed = np.setdiff1d(np.arange(len(lowest)), self._component[pins])  # components without a pin
        self._placed_by = lowest[self._placed]
        self._free = np.setdiff1d(np.arange(n), np.concatenate([pins, self._placed_by]))
        self._from_vertices, self._from_normals = from_vertices[self._free], from_normals[self._free]
        self._factor = factor_spd(stiffness[self._free][:, self._free]) if len(self._free) else None

    def transfer(self, V_deformed: MeshLike) -> NDArray[np.float64]:
        """Give the target the deformations of the source.

        Parameters
        ----------
        V_deformed : (n, 3) or (k, n, 3) float, or trimesh.Trimesh
            The source deformed. Triangles may collapse; the source itself gives the target, exactly.

        Returns
        -------
        float64 of the same shape
            The target deformed.

        Raises
        ------
        ValueError
            If the shape does not fit or a coordinate is not finite.
        """
        shapes = np.asarray(validate_like(V_deformed, self._corners.T, name="V_deformed", like="V_source"))
        n = len(self._source)
        if shapes.ndim not in (2, 3) or shapes.shape[-2:] != (n, 3) or shapes.dtype.kind not in "fiu":
            raise ValueError(
                f"V_deformed: expected real numbers of shape ({n}, 3) or (k, {n}, 3), got {shapes.dtype} {shapes.shape}"
            )
        if not np.isfinite(shapes).all():
            raise ValueError(f"V_deformed: expected finite coordinates, got {(~np.isfinite(shapes)).sum()} others")
        if shapes.ndim == 2:
            return self._transfer_one(shapes)
        result = np.empty(shapes.shape)
        for i, shape in enumerate(shapes):  # one by one: three right-hand sides fit the cache, many do not
            result[i] = self._transfer_one(shape)
        return result

    __call__ = transfer

    def displacements(self, motions: Sequence[SourceMotion]) -> NDArray[np.float64]:
        """How the target moves (k, n, 3) in motions of the source that were prepared once for many targets."""
        count, n = len(motions), len(self._source)
        result = np.zeros((count, n, 3))
        if self._factor is not None:
            right = np.hstack([self._right_side(motion) for motion in motions])
            result[:, self._free] = solve(self._factor, right).reshape(-1, count, 3).swapaxes(0, 1)
        offset = np.zeros((self._n_components, 3))
        for motion, displacement in zip(motions, result, strict=True):
            offset[self._placed] = motion.moved[self._placed_by] @ self._rotation.T
            displacement += offset[self._component]
        return result

    def _transfer_one(self, shape: NDArray[np.float64]) -> NDArray[np.float64]:
        # Displacements are solved for: no deformation then gives the target to the last bit.
        motion = source_motion(self._source, self._corners, np.asarray(shape, np.float64) - self._source)
        return np.asarray(self._target + self.displacements([motion])[0])

    def _right_side(self, motion: SourceMotion) -> NDArray[np.float64]:
        tilted = np.zeros((self._corners.shape[1], 3))
        tilted[motion.touched] = motion.tilted
        right = self._from_vertices @ motion.moved.astype(np.float64) + self._from_normals @ tilted
        return np.asarray(right @ self._rotation.T)


def _checked_pins(pinned: ArrayLike | None, n: int) -> NDArray[np.int64]:
    if pinned is None:
        return np.zeros(0, dtype=np.int64)
    pins = np.asarray(pinned)
    if pins.ndim != 1 or (pins.size and pins.dtype.kind not in "iu"):
        raise ValueError(f"pinned: expected integers of shape (p,), got {pins.dtype} {pins.shape}")
    outside = (pins < 0) | (pins >= n)
    if outside.any():
        raise ValueError(f"pinned: expected vertex indices in 0..{n - 1}, got {pins[outside.argmax()]}")
    return pins.astype(np.int64)
