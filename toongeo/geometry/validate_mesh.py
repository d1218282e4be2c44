"""The input check every mesh function shares."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["degenerate_triangles", "validate_faces", "validate_mesh", "validate_vertices"]

# Twice the area over the longest edge squared: the sine of the smallest angle, about. Below it, one rounding
# error decides the normal.
_DEGENERATE = 1e-12


def validate_mesh(
    V: ArrayLike, F: ArrayLike, *, names: tuple[str, str] = ("V", "F"), nondegenerate: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Check a triangle mesh and give it back as float64 and int64, C-contiguous.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, any unit.
    F : (m, 3) int
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
    V = validate_vertices(V, name=names[0])
    F = validate_faces(F, len(V), name=names[1])
    if nondegenerate:
        bad = np.flatnonzero(degenerate_triangles(V, F))
        if len(bad):
            raise ValueError(
                f"{names[0]}: expected triangles with an area, got {len(bad)} degenerate of {len(F)}, "
                f"the first {names[1]}[{bad[0]}] = {F[bad[0]].tolist()}"
            )
    return V, F


def validate_vertices(V: ArrayLike, *, name: str = "V") -> NDArray[np.float64]:
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
    return V


def validate_faces(F: ArrayLike, n: int, *, name: str = "F") -> NDArray[np.int64]:
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


def degenerate_triangles(V: NDArray[np.float64], F: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Mask (m,) of the triangles whose normal is lost in rounding. Scale-free; expects checked arrays."""
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    twice_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    sides = np.stack([b - a, c - b, a - c], axis=1)
    longest = np.einsum("fij,fij->fi", sides, sides).max(axis=1)
    return twice_area <= _DEGENERATE * longest
