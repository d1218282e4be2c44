"""Teeth and tongue that stay behind lips and cheeks.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/alignment.py``, ``benchmarks/lips.py``).
"""

from functools import lru_cache

import igl
import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.straighten_teeth import PARTS

__all__ = ["STEP", "STEPS", "enclosed", "keep_teeth_inside"]

_CLEARANCE = 1.05  # how much wider and longer the rows could be without coming out
STEP, STEPS = 0.95, 14  # by which they shrink at a time, and how often at most: to a half


def keep_teeth_inside(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Make teeth and tongue narrower and shorter, but not lower, until the skin encloses them.

    They shrink towards the back of the mouth, so that the front goes back behind the lips and the sides come in from
    the cheeks, all parts alike, so that the bite stays. Vertices that are inside already stay where they are.

    Parameters
    ----------
    model : MorphableModel
    V : (n, 3) float, mm, model frame

    Returns
    -------
    (n, 3) float64
        As given, if the model has no such parts, or no cavity for them.
    """
    held = np.any([model.region(name) for name in PARTS], axis=0)
    if not (held.any() and model.has("mouth_cavity")):
        return V
    skin = V - V[held].mean(0)
    parts = skin[held]
    back = np.array([0.0, 0.0, parts[:, 2].min()])
    sizes = STEP ** np.arange(STEPS)
    for size in sizes:
        if enclosed(model, skin, back + (parts - back) * [_CLEARANCE * size, 1, _CLEARANCE * size]).all():
            break
    kept = V.copy()
    if size < 1:
        kept[held] = V[held] + (parts - back) * [size - 1, 0, size - 1]
    return kept


def enclosed(model: MorphableModel, V: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Whether points (k, 3) lie behind the skin with vertices V (n, 3), its mouth stopped up by a fan.

    Their winding number about the skin is nearly 1; the open neck takes away a little.
    """
    skin, rim = _skin_and_rim(model)
    fan = np.column_stack([rim[:, ::-1], np.full(len(rim), len(V))])
    middle = V[rim[:, 0]].mean(0)
    winding = igl.fast_winding_number(np.vstack([V, middle]), np.vstack([skin, fan]), np.ascontiguousarray(points))
    return np.asarray(winding > 0.5)


@lru_cache(maxsize=4)
def _skin_and_rim(model: MorphableModel) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of the skin (m, 3), and their edges (k, 2) around the mouth."""
    cavity = model.region("mouth_cavity")
    skin = model.faces[model.region("skin")[model.faces].all(1)].astype(np.int64)
    edges = skin[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, first, count = np.unique(np.sort(edges, 1), axis=0, return_index=True, return_counts=True)
    border = edges[first[count == 1]]
    touching = np.unique(model.faces[cavity[model.faces].any(1)])
    return skin, border[np.isin(border, touching).all(1)]
