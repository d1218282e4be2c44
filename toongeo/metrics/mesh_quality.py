"""How sound a mesh is: self-intersections and folds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo.geometry.self_intersections import self_intersections
from toongeo.geometry.validate_mesh import validate_mesh

__all__ = ["MeshQuality", "mesh_quality"]


@dataclass(frozen=True, eq=False)
class MeshQuality:
    """What `mesh_quality` found.

    Attributes
    ----------
    intersecting : (i,) int64
        Sorted numbers of the selected triangles that intersect another triangle of the mesh.
    folded : (e, 2) int64
        Folded edges of the selected triangles: vertex pairs ``i < j``, sorted.
    selected : int
        How many triangles were looked at.

    Examples
    --------
    >>> from toongeo.metrics import mesh_quality
    >>> V = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> quality = mesh_quality(V, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> quality.intersecting_fraction, quality.selected
    (0.0, 4)
    """

    intersecting: NDArray[np.int64]
    folded: NDArray[np.int64]
    selected: int

    __repr__ = brief_repr

    @property
    def intersecting_fraction(self) -> float:
        """Share of the selected triangles that intersect another, 0..1."""
        return len(self.intersecting) / self.selected

    @property
    def folded_count(self) -> int:
        """Number of folded edges."""
        return len(self.folded)


def mesh_quality(
    V: ArrayLike, F: ArrayLike, *, selection: ArrayLike | None = None, fold_angle: float = 100.0
) -> MeshQuality:
    """Find self-intersecting triangles and folded edges.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, any unit.
    F : (m, 3) int
        Triangles, consistently oriented.
    selection : (m,) bool, optional
        Triangles to report on, for example those of one region; default all. They are tested against the
        whole mesh.
    fold_angle : float
        An edge is folded if the normals of its two triangles differ by more than this, in degrees.

    Returns
    -------
    MeshQuality

    Raises
    ------
    ValueError
        On a malformed mesh, a selection that does not fit or is empty, or an angle outside (0, 180).

    See Also
    --------
    toongeo.geometry.self_intersections : what counts as an intersection.

    Examples
    --------
    >>> V = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0.5, 0.5, -1], [0.5, 0.5, 1], [5, 5, 0]]
    >>> mesh_quality(V, [[0, 1, 2], [3, 4, 5]]).intersecting_fraction
    1.0
    """
    vertices, faces = validate_mesh(V, F)
    if not 0 < fold_angle < 180:
        raise ValueError(f"fold_angle: expected degrees in (0, 180), got {fold_angle}")
    chosen = np.ones(len(faces), dtype=bool) if selection is None else np.asarray(selection)
    if chosen.shape != (len(faces),) or chosen.dtype != bool:
        raise ValueError(f"selection: expected bool of shape ({len(faces)},), got {chosen.dtype} {chosen.shape}")
    if not chosen.any():
        raise ValueError("selection: expected at least one triangle, got none")
    hit = np.unique(self_intersections(vertices, faces))
    return MeshQuality(hit[chosen[hit]], _folded_edges(vertices, faces, chosen, fold_angle), int(chosen.sum()))


def _folded_edges(
    V: NDArray[np.float64], F: NDArray[np.int64], chosen: NDArray[np.bool_], fold_angle: float
) -> NDArray[np.int64]:
    """Edges of exactly two triangles, one of them chosen, whose normals differ too much."""
    start, end = F.ravel(), np.roll(F, -1, axis=1).ravel()
    key = np.minimum(start, end) * len(V) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    edges, first, count = np.unique(key[order], return_index=True, return_counts=True)
    two = count == 2
    a, b = order[first[two]] // 3, order[first[two] + 1] // 3

    normal = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    length = np.linalg.norm(normal, axis=1)
    cosine_times_lengths = np.einsum("ij,ij->i", normal[a], normal[b])
    # Strictly below: a triangle without area has no normal and cannot be folded.
    folded = cosine_times_lengths < np.cos(np.radians(fold_angle)) * length[a] * length[b]
    folded &= (length[a] > 0) & (length[b] > 0) & (chosen[a] | chosen[b])
    return np.stack(np.divmod(edges[two][folded], len(V)), axis=1)
