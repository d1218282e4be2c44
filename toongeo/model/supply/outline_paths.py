"""Where the outline of a head can lie: paths over its sides, found from its shape.

Constants were judged on the template, whose contour lines were drawn by hand, and on the Surrey model beside eos
(``benchmarks/eos.py``).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry import vertex_normals
from toongeo.model.ibug68 import OUTER_EYES, PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.eye_frame import EYE_DEPTH_MM

__all__ = ["outline_landmarks", "outline_paths", "with_contours"]

_BRIDGE, _NOSE_BASE, _LOWER_LIP = range(27, 31), 33, 57
_CHIN = 1.3  # of the height from lower lip to nose: as far below the lip a chin ends, with a margin for long ones
# How far behind the eyes, in outer-eye distances, paths end: under the chin, and at the ears. Behind are neck and nape.
_ENDS = 0.3, 0.95
_CORNERS = 36, 39, 42, 45  # of the eyes
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

    In 17 directions from the bridge of the nose, at equal angles from the height of the eyes round the chin, the first
    vertex of a path of :func:`outline_paths` that turns away from the camera; the farthest one of a path that does not.
    """
    _, radius, _ = _directions(model, landmarks)
    away = vertex_normals(model.mean, model.faces)[:, 2] <= 0
    found = []
    for line in outline_paths(model, landmarks):
        found.append(line[away[line].argmax()] if away[line].any() else line[np.argmax(radius[line])])
    return np.array(found, np.int64)


def outline_paths(model: MorphableModel, landmarks: NDArray[np.int64]) -> tuple[NDArray[np.int64], ...]:
    """For each jaw point the vertices on which it can lie, from the front to the back of the head.

    In the direction of a jaw point, at steps of depth, the vertex that is farthest from the middle of the face: where
    the outline passes when the head turns. Lines begin on the cheek and end at the ear and under the chin, or where
    the mesh does.

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
    eyes = float(np.linalg.norm(np.subtract(*model.mean[landmarks[list(OUTER_EYES)]])))
    middle = model.mean[landmarks[list(_CORNERS)], 2].mean() - EYE_DEPTH_MM
    back = middle - eyes * np.interp(np.abs(np.arange(17) - 8), (0, 8), _ENDS)
    paths = []
    for rows, end in zip(near, back, strict=True):
        rows = rows[radius[rows] > _LEAST_RADIUS * radius[rows].max()]
        rows = rows[depth[rows] > end] if (depth[rows] > end).any() else rows
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
    nose, lip = (model.mean[landmarks[k], 1] for k in (_NOSE_BASE, _LOWER_LIP))
    skin = model.region("skin") & (model.mean[:, 1] > lip - _CHIN * (nose - lip))
    near = []
    for k in range(len(PARTS["jaw"])):
        off = np.abs((angle - (-np.pi + k * np.pi / 16) + np.pi) % (2 * np.pi) - np.pi)
        for sector in (_SECTOR, 2 * _SECTOR, 8 * _SECTOR):  # wider where the mesh is coarse
            rows = np.flatnonzero(skin & (off < sector))
            if len(rows):
                break
        near.append(rows if len(rows) else np.array([np.argmin(off)]))
    return angle, radius, near
