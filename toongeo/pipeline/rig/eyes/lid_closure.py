"""How far a blink closes an eye.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import numpy as np

from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.anatomy.lid_rings import LidRings

__all__ = ["across_opening", "lid_closure", "opening_gaps"]

_GAZE = np.array([0.0, 0.0, 1.0])  # where a resting eye looks, model frame
_OPEN = 0.03  # of the opening's width: lids that are apart by less are shut
_FINE = 200  # points of a lid's edge to which distances are measured
_CORNER = 3  # columns at either corner, where the lids are one


def lid_closure(rings: LidRings, neutral: np.ndarray, blink: np.ndarray) -> float:
    """Closure of an eye in percent: 100 is shut, 0 as open as in the neutral face.

    Parameters
    ----------
    rings : LidRings
    neutral, blink : (n, 3) float, mm
        Vertices of the head with the eye as it is, and closed.

    Returns
    -------
    float
        The greatest distance that is left between the edges of the lids, measured across the opening, against that of
        the neutral face. 100 for an eye that is shut in the neutral face and stays so.
    """
    across = across_opening(rings, neutral)
    corners = neutral[rings.upper[0, -1]] - neutral[rings.upper[0, 0]]
    width = float(np.linalg.norm(corners))
    before, after = (_widest(rings, V, corners / width, across) for V in (neutral, blink))
    return 100.0 * (1 - min(1.0, max(0.0, after) / max(before, _OPEN * width)))


def _widest(rings: LidRings, V: np.ndarray, along_opening: np.ndarray, across: np.ndarray) -> float:
    """Greatest height, mm, of the inner edge of the upper lid over that of the lower one at the same place."""
    front = np.column_stack([along_opening, across])
    upper, lower = V[rings.upper[0]] @ front, V[rings.lower[0]] @ front
    order = np.argsort(lower[:, 0], kind="stable")
    height = upper[:, 1] - np.interp(upper[:, 0], lower[order, 0], lower[order, 1])
    # Beside the steep ends of a slanted opening the other lid is nearer than it is below.
    curve = interpolated(np.linspace(0, 1, _FINE), arc_shares(lower), lower)
    nearest = np.linalg.norm(upper[:, None] - curve, axis=2).min(1)
    return float(np.minimum(height, nearest)[_CORNER:-_CORNER].max())


def opening_gaps(rings: LidRings, V: np.ndarray, across: np.ndarray) -> np.ndarray:
    """How far, in mm, the edge of the upper lid is above that of the lower one; negative where it hangs over it."""
    upper, lower = V[rings.upper[0]], V[rings.lower[0]]
    return np.asarray((upper - interpolated(arc_shares(upper), arc_shares(lower), lower)) @ across)


def across_opening(rings: LidRings, V: np.ndarray) -> np.ndarray:
    """Unit vector (3,) square to the line between the corners and to the resting gaze, from lower to upper lid."""
    along_opening = V[rings.upper[0, -1]] - V[rings.upper[0, 0]]
    across = np.cross(_GAZE, along_opening)
    up = (V[rings.upper[2]].mean(0) - V[rings.lower[2]].mean(0)) @ across
    return np.asarray(across * np.sign(up or 1.0) / np.linalg.norm(across))
