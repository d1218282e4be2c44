"""How far eyes have closed and the mouth has opened between two expressions.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

from functools import lru_cache

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.lid_rings import lid_rings, opening_height
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rims import rim_path

__all__ = ["inner_rims", "jaw_moved", "lid_closing", "lips_parted"]

_CLOSED = 0.75  # of its height: an opening that has lost so much shows the lid of a closed eye
_TOUCHING, _PARTED = 0.035, 0.09  # of the mouth's width: lips so far apart still touch, and show the inside


def lid_closing(model: MorphableModel, source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """For the left and the right eye, 0 where it is as open as before, 1 where it has closed (2,)."""
    closing = np.zeros(2)
    for side, name in enumerate(SIDES):
        rings = lid_rings(model, name)
        before, after = (opening_height(V[rings.upper[0]], V[rings.lower[0]]) for V in (source, target))
        width = float(np.linalg.norm(source[rings.upper[0, 0]] - source[rings.upper[0, -1]]))
        closing[side] = np.clip((1 - after / max(before, 0.02 * width)) / _CLOSED, 0, 1)
    return closing * closing * (3 - 2 * closing)


def lips_parted(model: MorphableModel, V: np.ndarray) -> float:
    """0 where the lips touch, 1 where they are parted enough to show the inside of the mouth."""
    upper, lower = inner_rims(model)
    width = float(np.linalg.norm(V[upper[0]] - V[upper[-1]]))
    apart = opening_height(V[upper], V[lower]) / max(width, 1e-9)
    return float(np.clip((apart - _TOUCHING) / (_PARTED - _TOUCHING), 0, 1))


def jaw_moved(model: MorphableModel, source: np.ndarray, target: np.ndarray) -> float:
    """How far the lower teeth, or else the chin, have moved, in widths of the mouth."""
    upper, _ = inner_rims(model)
    width = float(np.linalg.norm(source[upper[0]] - source[upper[-1]]))
    jaw = model.region("teeth_lower") if model.has("teeth_lower") else model.landmarks[8:9]
    return float(np.linalg.norm((target - source)[jaw], axis=1).mean() / max(width, 1e-9))


@lru_cache(maxsize=4)
def inner_rims(model: MorphableModel) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of the upper and the lower inner rim of the lips, from corner to corner."""
    return rim_path(model, "lip_upper_inner"), rim_path(model, "lip_lower_inner")
