"""Linear classifiers of faces of people and of figures, seen from the left, the front and the right."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.frames import box_of

__all__ = ["FIGURES", "VIEWS", "classifier", "view_classifiers", "view_of"]

_SIDES = 3
VIEWS = 2 * _SIDES  # one template for both faces with nostrils and faces with a stroke for a nose would be neither
FIGURES = ("exaggerated", "figure")
_TURNED = 0.12  # radii between the bridge of the nose and the middle of the points


def view_of(points: NDArray[np.float64], kind: str) -> int:
    """0, 1 or 2: the face (68, 2) looks to the left of the picture, ahead, to the right; 3 more for drawn kinds."""
    box = box_of(points)
    side = (points[27:31, 0].mean() - box[0]) / box[2]
    turned = 0 if side < -_TURNED else 2 if side > _TURNED else 1
    return turned + _SIDES * (kind in FIGURES)


def view_classifiers(
    faces: NDArray[np.float32], views: NDArray[np.int64], clutter: NDArray[np.float32], ridge: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Weights (6, d) and offsets (6,) of a classifier for each view against clutter."""
    weights, offsets = [], []
    for view in range(VIEWS):
        mine = faces[views == view] if (views == view).any() else faces  # a toy may lack a view
        w, offset = classifier(mine, clutter, ridge)
        weights.append(w)
        offsets.append(offset)
    return np.array(weights, np.float32), np.array(offsets, np.float32)


def classifier(
    ones: NDArray[np.float32], others: NDArray[np.float32], ridge: float
) -> tuple[NDArray[np.float64], float]:
    """Weights (d,) and offset of the least squares fit to +1 for some rows (n, d), -1 for others (m, d).

    Both classes weigh the same; `ridge` is in units of the mean variance of a coordinate.
    """
    rows = np.concatenate([ones, others])
    aims = np.repeat([1.0, -1.0], [len(ones), len(others)]).astype(np.float32)
    shares = np.repeat([0.5 / len(ones), 0.5 / len(others)], [len(ones), len(others)]).astype(np.float32)
    mean, aim = shares @ rows, float(shares @ aims)
    rows = (rows - mean) * np.sqrt(shares)[:, None]
    normal = (rows.T @ rows).astype(np.float64)
    normal[np.diag_indices_from(normal)] += ridge * np.trace(normal) / len(normal)
    w = np.linalg.solve(normal, rows.T @ (np.sqrt(shares) * (aims - np.float32(aim))))
    return w, aim - mean @ w
