"""Where the surface of a model lies in its texture."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.model.morphable_model import MorphableModel

__all__ = ["Atlas", "atlas_coordinates"]

_BORDER = 0.01  # of the atlas, left free around the head, so that filtering does not bleed into an eyeball


@dataclass(frozen=True, eq=False)
class Atlas:
    """Texture coordinates of a surface.

    Attributes
    ----------
    uv : (t, 2) float64
        In [0, 1], origin bottom left.
    uv_faces : (m, 3) int64
        Corners of the surface's triangles in ``uv``.
    height : (t,) float64, mm, or None
        Where two places of the surface share a texel, it shows the higher one. None: no two do.
    """

    uv: NDArray[np.float64]
    uv_faces: NDArray[np.int64]
    height: NDArray[np.float64] | None = None

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "uv", "uv_faces", "height")


@lru_cache(maxsize=4)
def atlas_coordinates(model: MorphableModel) -> Atlas:
    """Texture coordinates of a model: its own, or longitude and latitude for one that has none.

    The globe stands about the middle of the head at the height of its landmarks, with the face at its equator and its
    seam at the back. Where a ray from there meets the surface twice (behind an ear, inside of the mouth) the places
    share the colour of the outermost. It keeps clear of the discs of the model's eyeballs.

    Parameters
    ----------
    model : MorphableModel

    Returns
    -------
    Atlas

    Examples
    --------
    >>> from dataclasses import replace
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> bool((atlas_coordinates(model).uv == model.uv).all())
    True
    >>> bare = replace(model, uv=np.zeros((0, 2)), uv_faces=np.zeros((0, 3), int), eyes=())
    >>> uv = atlas_coordinates(bare).uv
    >>> bool(abs(uv[model.landmarks[30], 0] - 0.5) < 0.1), bool(uv.min() > 0), bool(uv.max() < 1)
    (True, True, True)
    """
    if model.has("uv", "uv_faces"):
        return Atlas(model.uv, model.uv_faces)
    low, high = model.mean.min(axis=0), model.mean.max(axis=0)
    middle = [0.0, model.mean[model.landmarks, 1].mean(), (low[2] + high[2]) / 2]
    x, y, z = (model.mean - middle).T
    longitude, latitude = np.arctan2(x, z), np.arctan2(y, np.hypot(x, z))
    # A triangle on the seam takes its western corners a turn farther east.
    across = longitude[model.faces]
    east = np.where(across < 0, across + 2 * np.pi, across)
    on_seam = (np.ptp(across, axis=1) > np.pi) & (np.ptp(east, axis=1) < np.pi / 2)  # the poles have none
    western = on_seam[:, None] & (across < 0)
    again, at = np.unique(model.faces[western], return_inverse=True)
    uv_faces = model.faces.astype(np.int64)
    uv_faces[western] = len(x) + at
    globe = np.column_stack([np.r_[longitude, longitude[again] + 2 * np.pi], np.r_[latitude, latitude[again]]])
    first, last = _free_box(model)
    start, size = globe.min(axis=0), np.ptp(globe, axis=0)
    uv = first + (globe - start) / np.where(size > 0, size, 1.0) * (last - first)
    height = np.linalg.norm(model.mean - middle, axis=1)
    return Atlas(uv, uv_faces, np.r_[height, height[again]])


def _free_box(model: MorphableModel) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower left and upper right corner of the largest strip beside the discs of the eyeballs."""
    whole = np.zeros(2), np.ones(2)
    boxes = [whole]
    if model.eyes:
        discs = np.concatenate([eye.uv for eye in model.eyes])
        low, high = discs.min(axis=0), discs.max(axis=0)
        boxes = [
            (np.zeros(2), np.array([low[0], 1.0])),
            (np.array([high[0], 0.0]), np.ones(2)),
            (np.zeros(2), np.array([1.0, low[1]])),
            (np.array([0.0, high[1]]), np.ones(2)),
        ]
    first, last = max(boxes, key=lambda box: float(np.prod(box[1] - box[0])))
    return first + _BORDER, last - _BORDER
