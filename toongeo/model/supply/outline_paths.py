"""Where the outline of a head can lie: paths over its sides, found from its shape.

Constants were judged on the template, whose contour lines were drawn by hand, and on the Surrey model beside eos
(``benchmarks/eos.py``).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import PARTS
from toongeo.model.morphable_model import MorphableModel

__all__ = ["outline_landmarks", "outline_paths", "with_contours"]

_BRIDGE = range(27, 31)
_SECTOR = np.radians(4.0)  # about a direction: half of what lies between two jaw points would be 5.6 degrees
_STEP_MM = 5.0  # of depth between two vertices of a path: as of the template's lines
_LEAST_RADIUS = 0.6  # of the outline's own in that direction: what lies nearer to the nose is never the outline


def with_contours(model: MorphableModel) -> MorphableModel:
    """A model with contour lines from `outline_paths`; its jaw landmarks become the vertices on its outline.

    Raises
    ------
    ValueError
        If the model has no landmarks.
    """
    landmarks = model.landmarks.copy()
    landmarks[PARTS["jaw"]] = outline_landmarks(model, landmarks)
    return replace(model, landmarks=landmarks, contour_lines=outline_paths(model, landmarks))


def outline_landmarks(model: MorphableModel, landmarks: NDArray[np.int64]) -> NDArray[np.int64]:
    """Vertices (17,) on the outline of the mean as the camera in front sees it.

    In 17 directions from the bridge of the nose, at equal angles from the height of the eyes round the chin, the vertex
    that is farthest away in the picture.
    """
    _, radius, near = _directions(model, landmarks)
    return np.array([rows[np.argmax(radius[rows])] for rows in near])


def outline_paths(model: MorphableModel, landmarks: NDArray[np.int64]) -> tuple[NDArray[np.int64], ...]:
    """For each jaw point the vertices on which it can lie, from the front to the back of the head.

    In the direction of a jaw point, at steps of depth, the vertex that is farthest from the middle of the face: where
    the outline passes when the head turns. Lines begin on the cheek and end behind the ear, or where the mesh does.

    Parameters
    ----------
    model : MorphableModel
    landmarks : (68,) int
        Of which only the bridge of the nose is looked at.

    Returns
    -------
    17 arrays of int64

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> lines = outline_paths(default_model(), default_model().landmarks)
    >>> len(lines), bool((np.diff(default_model().mean[lines[8], 2]) <= 0).all())
    (17, True)
    """
    _, radius, near = _directions(model, landmarks)
    depth = model.mean[:, 2]
    paths = []
    for rows in near:
        rows = rows[radius[rows] > _LEAST_RADIUS * radius[rows].max()]
        step = np.floor(depth[rows] / _STEP_MM)
        line = [rows[step == s][np.argmax(radius[rows[step == s]])] for s in np.unique(step)[::-1]]
        paths.append(np.array(line, np.int64))
    return tuple(paths)


def _directions(
    model: MorphableModel, landmarks: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], list[NDArray[np.int64]]]:
    """Angle and distance (n,) of vertices about the bridge of the nose; those near each jaw point's direction."""
    if not landmarks.size:
        raise ValueError("model: expected one with landmarks, got one without: model.with_landmarks(vertices)")
    away = (model.mean - model.mean[landmarks[list(_BRIDGE)]].mean(axis=0))[:, :2]
    angle, radius = np.arctan2(away[:, 1], away[:, 0]), np.hypot(*away.T)
    skin = model.region("skin")
    near = []
    for k in range(len(PARTS["jaw"])):
        off = np.abs((angle - (-np.pi + k * np.pi / 16) + np.pi) % (2 * np.pi) - np.pi)
        for sector in (_SECTOR, 2 * _SECTOR, 8 * _SECTOR):  # wider where the mesh is coarse
            rows = np.flatnonzero(skin & (off < sector))
            if len(rows):
                break
        near.append(rows if len(rows) else np.array([np.argmin(off)]))
    return angle, radius, near
