"""Ears that keep their shape.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import numpy as np
from scipy.spatial import cKDTree

from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel
from toongeo.model.anatomy.parts import SIDES

__all__ = ["keep_ears_rigid"]

_ROOT = 0.12  # of an ear's height: over this distance from its root it follows the head


def keep_ears_rigid(model: MorphableModel, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Replace the motion of each ear by the nearest turn, shift and growth.

    No landmark sees an ear, so what pulls at jaw and temple draws it out into a flap. At its root, where it grows out
    of the head, it goes on as the skin does.

    Parameters
    ----------
    model : MorphableModel
    before, after : (n, 3) float, mm, model frame

    Returns
    -------
    (n, 3) float64
        ``after``, with ears of the shape that they had, as far as the model has them.
    """
    kept = after.copy()
    for name in (f"ear_{side}" for side in SIDES):
        ear = model.region(name)
        border = model.faces[ear[model.faces].any(1) & ~ear[model.faces].all(1)]
        root = np.unique(border[~ear[border]])
        if not len(root):
            continue
        scale, rotation, shift = similarity(before[ear], after[ear])
        placed = scale * before @ rotation.T + shift
        reach = _ROOT * float(np.ptp(before[ear, 1]))
        away, nearest = cKDTree(before[root]).query(before[ear])
        residual = (after - placed)[root][nearest]
        kept[ear] = placed[ear] + np.exp(-((away / reach) ** 2))[:, None] * residual
    return kept
