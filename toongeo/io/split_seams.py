"""One index a corner, for file formats that know no separate uv faces."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["split_seams"]


def split_seams(
    faces: ArrayLike, uv_faces: ArrayLike
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Repeat a vertex for each uv it has.

    Parameters
    ----------
    faces
        (m, 3) into the vertices.
    uv_faces
        (m, 3) into the uv.

    Returns
    -------
    vertex : (p,) int64
        Vertex of each point, ascending; vertices in no face have no point.
    uv : (p,) int64
        uv of each point.
    faces : (m, 3) int64
        Into the points: ``vertex[faces]`` is the first argument, ``uv[faces]`` the second.

    Raises
    ------
    ValueError
        If the shapes differ.

    Examples
    --------
    >>> vertex, uv, split = split_seams([[0, 1, 2], [0, 2, 3]], [[0, 1, 2], [4, 2, 3]])
    >>> vertex
    array([0, 0, 1, 2, 3])
    >>> uv
    array([0, 4, 1, 2, 3])
    """
    F, F_uv = np.asarray(faces, dtype=np.int64), np.asarray(uv_faces, dtype=np.int64)
    if F.shape != F_uv.shape or F.ndim != 2 or F.shape[1] != 3:
        raise ValueError(f"uv_faces: expected the (m, 3) of faces {F.shape}, got {F_uv.shape}")
    count = int(F_uv.max(initial=0)) + 1
    keys, corner = np.unique(F * count + F_uv, return_inverse=True)
    return keys // count, keys % count, corner.reshape(F.shape)
