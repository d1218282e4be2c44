"""One mesh laid on another of a different topology."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.geometry.facing_surface import FACING, FacingSurface
from toongeo.geometry.landmark_matrix import landmark_matrix
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.geometry.registration.thin_shell import ThinShell
from toongeo.geometry.rotations.similarity import similarity
from toongeo.geometry.validate_mesh import MeshLike, validate_mesh

__all__ = ["RegisteredMesh", "nonrigid_register"]

_STIFFNESS = (0.3, 0.03, 0.003, 0.0003)  # from a plate that hardly bends to one that follows; a decade a stage
_ITERATIONS = 4  # of closest points a stage
_MATCHED = 0.1  # units: a partner farther away in the end is none
_CONVERGED = 1e-3  # units: mean step of the last iteration


@dataclass(frozen=True, eq=False)
class RegisteredMesh:
    """A source mesh deformed onto a target.

    Attributes
    ----------
    vertices : (n, 3) float64, frame and unit of the target
        The source deformed.
    faces : (n,) int64
        Triangle of the target with each vertex's partner: the closest point that faces the same way, if there is one.
    barycentric : (n, 3) float64
        Where in that triangle.
    distances : (n,) float64, unit of the target
        To the partner.
    matched : (n,) bool
        Vertices with a partner that faces the same way, is not at a border of the target, and is nearer than a tenth of
        the spread of the landmarks.
    landmark_errors : (k,) float64, unit of the target
        NaN where a landmark is missing.
    scale, rotation, shift : float, (3, 3), (3,)
        The similarity ``scale * V_source @ rotation.T + shift`` from which the deformation started.
    iterations : int
    status : {"converged", "iteration limit"}
        Whether the last iteration moved the vertices by less than a thousandth of the spread of the landmarks, on
        average.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> found = tg.nonrigid_register(V, F, 2 * V + 5, F, [0, 1, 2, 3], [0, 1, 2, 3])
    >>> found.status, round(found.scale, 9), bool(found.distances.max() < 1e-9)
    ('converged', 2.0, True)
    >>> bool(np.allclose(found.scale * V @ found.rotation.T + found.shift, 2 * V + 5))  # where it started
    True
    """

    vertices: Floats
    faces: NDArray[np.int64]
    barycentric: Floats
    distances: Floats
    matched: NDArray[np.bool_]
    landmark_errors: Floats
    scale: float
    rotation: Floats
    shift: Floats
    iterations: int
    status: str

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        names = ("vertices", "faces", "barycentric", "distances", "matched", "landmark_errors", "rotation", "shift")
        read_only(self, *names)


def nonrigid_register(
    V_source: MeshLike,
    F_source: ArrayLike | None,
    V_target: MeshLike,
    F_target: ArrayLike | None,
    source_landmarks: ArrayLike,
    target_landmarks: ArrayLike,
    *,
    fitted: ArrayLike | None = None,
    landmark_weight: ArrayLike = 1.0,
    stiffness: Sequence[float] = _STIFFNESS,
    iterations: int = _ITERATIONS,
) -> RegisteredMesh:
    """Deform a mesh onto another one by landmarks and regularized non-rigid closest points.

    A similarity brings the landmarks together. Then, at ever lower stiffness, every vertex looks for the closest point
    of the target that faces the same way, and moves towards it, mostly across the surface; a thin shell's resistance
    against bending and stretching (of the displacements, since the stiffness was last lowered) keeps the motion smooth.
    Partners at borders of the target or much farther away than others pull less or not at all.

    Parameters
    ----------
    V_source : (n, 3) float, or trimesh.Trimesh
    F_source : (m, 3) int, or None with a Trimesh
    V_target : (p, 3) float, or trimesh.Trimesh
        Any unit, any pose.
    F_target : (q, 3) int, or None with a Trimesh
        Any topology, oriented like the source's.
    source_landmarks, target_landmarks : (k,) int or (k, 3) float
        Vertices, or points on or near the surface; row i of one belongs to row i of the other. A row with NaN is
        missing; at least three must be left, not all on a line.
    fitted : (n,) bool, optional
        Source vertices that have a counterpart on the target; the others (the inside of a mouth, say) are taken along.
    landmark_weight : float or (k,) float
        How strictly landmarks are met: about the share of the source's area that pulls as strongly.
    stiffness : sequence of float
        Descending.
    iterations : int
        At each stiffness.

    Returns
    -------
    RegisteredMesh

    Raises
    ------
    ValueError
        On malformed meshes, triangles of the source without area, landmarks out of range, not in pairs, too few, or on
        a line, options out of range, and where no vertex finds a partner.

    References
    ----------
    R. W. Sumner, J. Popovic, "Deformation transfer for triangle meshes", 2004, section 5 (correspondence).
    B. Amberg, S. Romdhani, T. Vetter, "Optimal step nonrigid ICP algorithms for surface registration", CVPR 2007.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> found = nonrigid_register(V, F, 2 * V + 5, F, [0, 1, 2, 3], [0, 1, 2, 3])
    >>> np.allclose(found.vertices, 2 * V + 5), round(found.scale, 9), found.status
    (True, 2.0, 'converged')
    """
    source, corners = validate_mesh(V_source, F_source, names=("V_source", "F_source"), nondegenerate=True)
    target, target_corners = validate_mesh(V_target, F_target, names=("V_target", "F_target"))
    at, given = landmark_matrix(source, corners, source_landmarks, "source_landmarks")
    at_target, given_target = landmark_matrix(target, target_corners, target_landmarks, "target_landmarks")
    if len(given) != len(given_target):
        raise ValueError(f"target_landmarks: expected {len(given)} as source_landmarks has, got {len(given_target)}")
    mask = _checked_mask(fitted, len(source))
    weights = _checked_weights(landmark_weight, len(given))
    levels = _checked_stiffness(stiffness, iterations)
    both = given & given_target
    at, points = at[both], at_target[both] @ target
    start = at @ source
    _check_landmarks(both, start, points)

    scale, rotation, shift = similarity(start, points)
    unit = float(np.sqrt(((start - start.mean(0)) ** 2).sum(1).mean()))
    # The target is brought to the source, not the source to it: what follows does not depend on the target's frame.
    shell = ThinShell(source / unit, corners, at, weights[both])
    surface = FacingSurface((target - shift) @ rotation / (scale * unit), target_corners)
    X, step = shell.laid_on(surface, (points - shift) @ rotation / (scale * unit), mask, levels, iterations)
    triangles, bary, cosines = surface.closest(X, vertex_normals(X, corners))
    distances = np.linalg.norm(surface.points(triangles, bary) - X, axis=1)
    matched = (cosines >= FACING) & ~surface.at_border(triangles, bary) & (distances <= _MATCHED)
    if mask.any() and not matched[mask].any():
        raise ValueError(
            "V_target: expected a surface on which the source can be laid, with triangles oriented like the source's, "
            "got one where no vertex finds a partner"
        )
    vertices = scale * unit * X @ rotation.T + shift
    errors = np.full(len(both), np.nan)
    errors[both] = np.linalg.norm(at @ vertices - points, axis=1)
    return RegisteredMesh(
        vertices=vertices,
        faces=triangles,
        barycentric=bary,
        distances=distances * scale * unit,
        matched=matched,
        landmark_errors=errors,
        scale=scale,
        rotation=rotation,
        shift=shift,
        iterations=len(levels) * iterations,
        status="converged" if step <= _CONVERGED else "iteration limit",
    )


def _checked_mask(fitted: ArrayLike | None, n: int) -> NDArray[np.bool_]:
    if fitted is None:
        return np.ones(n, bool)
    mask = np.asarray(fitted)
    if mask.shape != (n,) or mask.dtype != bool:
        raise ValueError(f"fitted: expected bool of shape ({n},), got {mask.dtype} {mask.shape}")
    return mask


def _checked_weights(weight: ArrayLike, k: int) -> Floats:
    weights = np.asarray(weight, np.float64)
    if weights.shape not in ((), (k,)) or not (np.isfinite(weights) & (weights > 0)).all():
        raise ValueError(f"landmark_weight: expected a number or ({k},) numbers, finite and > 0, got {weight!r}")
    return np.broadcast_to(weights, (k,)).copy()


def _checked_stiffness(stiffness: Sequence[float], iterations: int) -> Floats:
    levels = np.asarray(stiffness, np.float64)
    if levels.ndim != 1 or len(levels) == 0 or not (np.isfinite(levels) & (levels > 0)).all():
        raise ValueError(f"stiffness: expected at least one finite number > 0, got {stiffness}")
    if isinstance(iterations, bool) or not isinstance(iterations, int | np.integer) or iterations < 1:
        raise ValueError(f"iterations: expected a whole number >= 1, got {iterations!r}")
    return levels


def _check_landmarks(both: NDArray[np.bool_], start: Floats, points: Floats) -> None:
    if both.sum() < 3:
        raise ValueError(
            f"target_landmarks: expected at least 3 that both meshes have, got {both.sum()} of {len(both)}"
        )
    for name, found in (("source_landmarks", start), ("target_landmarks", points)):
        spread = np.linalg.svd(found - found.mean(0), compute_uv=False)
        if spread[1] <= 1e-6 * spread[0]:
            raise ValueError(f"{name}: expected points that are not all on a line, got {len(found)} that are")
