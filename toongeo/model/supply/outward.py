"""Triangles that face outwards."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["faces_inward", "outward"]


def outward(V: NDArray[np.float64], F: NDArray[np.int64]) -> NDArray[np.int64]:
    """The triangles of a head, all turned about if they face into it.

    Files of face models differ in this, even copies of the same model.

    Examples
    --------
    >>> V = np.array([[-1.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, -2]])
    >>> outward(V, np.array([[0, 2, 1]])), outward(V, np.array([[0, 1, 2]]))
    (array([[1, 2, 0]]), array([[0, 1, 2]]))
    """
    return np.ascontiguousarray(F[:, ::-1]) if faces_inward(V, F) else F


def faces_inward(V: NDArray[np.float64], F: NDArray[np.int64]) -> bool:
    """Whether the volume between a surface and the middle of its back is negative.

    Seen from there a face mask, which is open behind, lies all in front, and a whole head all around.
    """
    centre = np.append(V[:, :2].mean(axis=0), V[:, 2].mean() if _closed(F) else V[:, 2].min())
    a, b, c = (V[F[:, k]] - centre for k in range(3))
    return bool(np.einsum("ij,ij->", a, np.cross(b, c)) < 0)


def _closed(F: NDArray[np.int64]) -> bool:
    low, high = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1).T
    return bool((np.unique(low * (int(F.max()) + 1) + high, return_counts=True)[1] == 2).all())
