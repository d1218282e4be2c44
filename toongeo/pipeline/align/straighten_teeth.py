"""Teeth and tongue that were carried along by a flow, as parts that do not bend."""

import numpy as np

from toongeo.model import MorphableModel

PARTS = ("teeth_upper", "teeth_lower", "tongue")
STRETCH = 1.8  # of the axis that is stretched least: how much the others may be


def straighten_teeth(model: MorphableModel, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Replace the motion of teeth and tongue by the nearest affine one, the same for all of them.

    Parameters
    ----------
    model : MorphableModel
    before, after : (n, 3) float, mm, model frame

    Returns
    -------
    (n, 3) float64
        ``after``, with teeth and tongue straightened.
    """
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    centre, arrived = before[inside].mean(0), after[inside].mean(0)
    linear, *_ = np.linalg.lstsq(before[inside] - centre, after[inside] - arrived, rcond=None)
    U, stretches, Vt = np.linalg.svd(linear)
    linear = (U * np.minimum(stretches, STRETCH * stretches[-1])) @ Vt
    straight = after.copy()
    straight[inside] = (before[inside] - centre) @ linear + arrived
    return straight
