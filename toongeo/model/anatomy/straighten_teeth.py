"""Teeth and tongue that were carried along by a flow, as parts that do not bend.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/alignment.py``, ``benchmarks/lips.py``).
"""

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.rims import rim_path

__all__ = ["PARTS", "PARTS_OF_RIM", "STRETCH", "straighten_teeth"]

# What hangs on the upper lip's side of the mouth, and what on the lower one's.
PARTS_OF_RIM = {"lip_upper_inner": ("teeth_upper",), "lip_lower_inner": ("teeth_lower", "tongue")}
PARTS = tuple(part for parts in PARTS_OF_RIM.values() for part in parts)
STRETCH = 1.8  # of the axis that is stretched least: how much the others may be


def straighten_teeth(model: MorphableModel, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Replace the motion of teeth and tongue by the nearest affine one, the same for all of them but for its shift.

    No landmark sees a tooth, so a flow takes it wherever the nearest features go: eyes that are drawn huge push both
    rows up behind the nose. The shift is therefore not the flow's: the upper row keeps its place beneath the middle of
    the upper lip, the lower row and the tongue theirs behind the lower lip.

    Parameters
    ----------
    model : MorphableModel
    before, after : (n, 3) float, mm, model frame

    Returns
    -------
    (n, 3) float64
        ``after``, with teeth and tongue straightened, as far as the model has them.
    """
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    if not inside.any():
        return after
    centre, arrived = before[inside].mean(0), after[inside].mean(0)
    linear, *_ = np.linalg.lstsq(before[inside] - centre, after[inside] - arrived, rcond=None)
    U, stretches, Vt = np.linalg.svd(linear)
    linear = (U * np.minimum(stretches, STRETCH * stretches[-1])) @ Vt
    straight = after.copy()
    for rim, parts in PARTS_OF_RIM.items():
        lip = rim_path(model, rim)
        held = np.any([model.region(name) for name in parts], axis=0)
        straight[held] = (before[held] - before[lip].mean(0)) @ linear + after[lip].mean(0)
    return straight
