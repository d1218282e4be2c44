"""Connected components of a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.operators.components import components
from toongeo.geometry.validate_mesh import validate_faces

__all__ = ["vertex_components"]


def vertex_components(F: ArrayLike, n: int) -> NDArray[np.int64]:
    """Component number of every vertex, numbered by their lowest vertex.

    Parameters
    ----------
    F : (m, 3) int
        Triangles.
    n : int
        Number of vertices.

    Returns
    -------
    (n,) int64
        Numbers from 0; a vertex without a triangle is a component of its own.

    Raises
    ------
    ValueError
        If `F` is not (m, 3) or an index is out of range.

    Examples
    --------
    >>> vertex_components([[0, 1, 2], [4, 5, 6]], 7)
    array([0, 0, 0, 1, 2, 2, 2])
    """
    return components(validate_faces(F, n), n)
