"""The input check every mesh function shares."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, TypeAlias

import igl
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats, Integers, Mask

if TYPE_CHECKING:
    import trimesh

__all__ = ["MeshLike", "degenerate_triangles", "validate_faces", "validate_like", "validate_mesh", "validate_vertices"]

MeshLike: TypeAlias = "ArrayLike | trimesh.Trimesh"  # vertices, or a mesh that stands for them and its triangles

# Twice the area over the longest edge squared: the sine of the smallest angle, about. Below it, one rounding
# error decides the normal.
_DEGENERATE = 1e-12
_LARGEST = 1e60  # of a coordinate: products of four lengths, of which solvers make sums, stay finite


def validate_mesh(
    V: MeshLike, F: ArrayLike | None = None, *, names: tuple[str, str] = ("V", "F"), nondegenerate: bool = False
) -> tuple[Floats, Integers]:
    """Check a triangle mesh and give it back as float64 and int64, C-contiguous.

    Every function that takes a mesh comes by here, and so takes either form of it.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices, any unit; or vertices and triangles in one, as they are.
    F : (m, 3) int, or None with a Trimesh
        Triangles, 0-based, m >= 1. Vertices without a triangle are allowed.
    names
        What to call the two arrays in messages.
    nondegenerate
        Also refuse triangles without area (twice the area at most 1e-12 of the longest edge squared).

    Returns
    -------
    V : (n, 3) float64
    F : (m, 3) int64
        Copies only where the conversion needs one.

    Raises
    ------
    ValueError
        Naming the array, what was expected and what came.

    Examples
    --------
    >>> V, F = validate_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> V.dtype, F.dtype
    (dtype('float64'), dtype('int64'))
    >>> validate_mesh(V, [[0, 1, 3]])
    Traceback (most recent call last):
    ...
    ValueError: F: expected indices in 0..2, got 3 in triangle 0
    """
    mesh = _trimesh(V)
    if mesh is not None and F is not None:
        raise ValueError(f"{names[1]}: expected None, since {names[0]} is a Trimesh with triangles of its own")
    if mesh is None and F is None:
        got = type(V).__name__
        raise ValueError(f"{names[1]}: expected triangles, or a trimesh.Trimesh as {names[0]}, got None and {got}")
    V = validate_vertices(V if mesh is None else mesh.vertices, name=names[0])
    F = validate_faces(F if mesh is None else mesh.faces, len(V), name=names[1])
    if nondegenerate:
        bad = np.flatnonzero(degenerate_triangles(V, F))
        if len(bad):
            raise ValueError(
                f"{names[0]}: expected triangles with an area, got {len(bad)} degenerate of {len(F)}, "
                f"the first {names[1]}[{bad[0]}] = {F[bad[0]].tolist()}"
            )
    return V, F


def validate_like(V: MeshLike, F: Integers, *, name: str = "V", like: str) -> Any:
    """Vertices of another shape of a checked mesh `like` with triangles F: an array as it came, or those of a Trimesh.

    Raises
    ------
    ValueError
        If it is a Trimesh with other triangles.
    """
    mesh = _trimesh(V)
    if mesh is not None and not np.array_equal(mesh.faces, F):
        got = f"{len(mesh.faces)} others"
        raise ValueError(f"{name}: expected a Trimesh with the {len(F)} triangles of {like}, got {got}")
    return V if mesh is None else np.asarray(mesh.vertices)


def _trimesh(V: object) -> Any:
    """V if it is a Trimesh, else None."""
    # Whoever holds a Trimesh has imported trimesh; the others need not wait for it.
    trimesh = sys.modules.get("trimesh")
    return V if trimesh is not None and isinstance(V, trimesh.Trimesh) else None


def validate_vertices(V: object, *, name: str = "V") -> Floats:
    """Finite (n, 3) float64 vertices, or a ValueError (see `validate_mesh`)."""
    V = np.asarray(V)
    if V.ndim != 2 or V.shape[1] != 3 or len(V) == 0 or V.dtype.kind not in "fiu":
        raise ValueError(f"{name}: expected real numbers of shape (n, 3), n >= 1, got {V.dtype} {V.shape}")
    V = np.ascontiguousarray(V, dtype=np.float64)
    finite = np.isfinite(V).all(axis=1)
    if not finite.all():
        raise ValueError(
            f"{name}: expected finite coordinates, got {(~finite).sum()} rows that are not, "
            f"the first {name}[{(~finite).argmax()}]"
        )
    if (most := float(np.abs(V).max())) > _LARGEST:
        raise ValueError(f"{name}: expected coordinates up to {_LARGEST:g}, got {most:g}")
    return V


def validate_faces(F: object, n: int, *, name: str = "F") -> Integers:
    """In-range (m, 3) int64 triangles of `n` vertices, or a ValueError (see `validate_mesh`)."""
    F = np.asarray(F)
    if F.ndim != 2 or F.shape[1] != 3 or len(F) == 0 or F.dtype.kind not in "iu":
        raise ValueError(f"{name}: expected integers of shape (m, 3), m >= 1, got {F.dtype} {F.shape}")
    F = np.ascontiguousarray(F, dtype=np.int64)
    outside = (F < 0) | (n <= F)
    if outside.any():
        row, column = divmod(int(outside.argmax()), 3)
        raise ValueError(f"{name}: expected indices in 0..{n - 1}, got {F[row, column]} in triangle {row}")
    return F


def degenerate_triangles(V: Floats, F: Integers) -> Mask:
    """Mask (m,) of the triangles whose normal is lost in rounding. Scale-free; expects checked arrays."""
    return np.asarray(igl.doublearea(V, F) <= _DEGENERATE * igl.squared_edge_lengths(V, F).max(axis=1))
