"""Vertex attributes at the pixels of a rasterized mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.render.rasterize import Fragments

__all__ = ["blend_corners", "interpolate"]

_CHUNK = 2**14  # pixels that stay in the cache


def interpolate(fragments: Fragments, F: ArrayLike, attributes: ArrayLike) -> NDArray[Any]:
    """Attributes of the vertices, interpolated linearly in the image, at every pixel.

    Parameters
    ----------
    fragments : Fragments
        From `rasterize`.
    F : array_like of int, shape (m, 3)
        The faces that were rasterized, or others of the same count: a row of ``uv_faces`` is the same
        triangle, with indices into ``uv``.
    attributes : array_like, shape (n, c) or (n,)
        One row a vertex.

    Returns
    -------
    ndarray, shape (height, width, c) or (height, width)
        float32 for float32 attributes, else float64; 0 where there is no face.

    Raises
    ------
    ValueError
        If the shapes do not fit, or an index is out of range.

    Examples
    --------
    >>> from toongeo.render import rasterize
    >>> F = [[0, 1, 2]]
    >>> fragments = rasterize([[0, 0], [2, 0], [0, 2]], F, 2, 2)
    >>> interpolate(fragments, F, [0.0, 10.0, 20.0])
    array([[ 0.,  5.],
           [10., 15.]])
    """
    values, faces = np.asarray(attributes), np.asarray(F)
    if values.ndim not in (1, 2):
        raise ValueError(f"attributes: expected shape (n, c) or (n,), got {values.shape}")
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise ValueError(f"F: expected shape (m, 3), got {faces.shape}")
    if int(fragments.face_ids.max(initial=-1)) >= len(faces):
        raise ValueError(f"F: expected the faces that were rasterized, got only {len(faces)}")
    if len(faces) and (faces.min() < 0 or faces.max() >= len(values)):
        raise ValueError(f"F: expected indices in [0, {len(values)}), got {faces.min()} to {faces.max()}")
    values = values.astype(np.result_type(values.dtype, np.float32), copy=False)
    corners = (values if values.ndim == 2 else values[:, None])[faces]
    covered = np.flatnonzero(fragments.face_ids.ravel() >= 0)
    image = np.zeros((fragments.face_ids.size, corners.shape[2]), corners.dtype)
    image[covered] = blend_corners(
        corners, fragments.face_ids.ravel()[covered], fragments.barycentrics.reshape(-1, 3)[covered]
    )
    return image.reshape(*fragments.face_ids.shape, *values.shape[1:])


def blend_corners(corners: NDArray[Any], ids: NDArray[np.integer], weights: NDArray[Any]) -> NDArray[Any]:
    """Values (k, c) in faces ``ids`` (k,) at ``weights`` (k, 3), from a table of corner values (m, 3, c)."""
    blended = np.empty((len(ids), corners.shape[2]), corners.dtype)
    for start in range(0, len(ids), _CHUNK):
        rows = slice(start, start + _CHUNK)
        np.einsum("kic,ki->kc", corners.take(ids[rows], axis=0), weights[rows], out=blended[rows])
    return blended
