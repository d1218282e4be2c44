"""Linear classifiers of faces seen from the left, the front and the right."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.frames import box_of

__all__ = ["VIEWS", "view_classifiers", "view_of"]

VIEWS = 3
_TURNED = 0.12  # radii between the bridge of the nose and the middle of the points


def view_of(points: NDArray[np.float64]) -> int:
    """0, 1 or 2: the face (68, 2) looks to the left of the picture, ahead, to the right."""
    box = box_of(points)
    side = (points[27:31, 0].mean() - box[0]) / box[2]
    return 0 if side < -_TURNED else 2 if side > _TURNED else 1


def view_classifiers(
    faces: NDArray[np.float32], views: NDArray[np.int64], clutter: NDArray[np.float32], ridge: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Weights (3, d) and offsets (3,) of least squares fits to +1 for faces of a view, -1 for clutter.

    Both classes weigh the same; `ridge` is in units of the mean variance of a coordinate.
    """
    weights, offsets = [], []
    for view in range(VIEWS):
        mine = faces[views == view] if (views == view).any() else faces  # a toy may lack a view
        rows = np.concatenate([mine, clutter])
        aims = np.repeat([1.0, -1.0], [len(mine), len(clutter)]).astype(np.float32)
        shares = np.repeat([0.5 / len(mine), 0.5 / len(clutter)], [len(mine), len(clutter)]).astype(np.float32)
        mean, aim = shares @ rows, float(shares @ aims)
        rows = (rows - mean) * np.sqrt(shares)[:, None]
        normal = (rows.T @ rows).astype(np.float64)
        normal[np.diag_indices_from(normal)] += ridge * np.trace(normal) / len(normal)
        w = np.linalg.solve(normal, rows.T @ (np.sqrt(shares) * (aims - np.float32(aim))))
        weights.append(w)
        offsets.append(aim - mean @ w)
    return np.array(weights, np.float32), np.array(offsets, np.float32)
