"""How far a blink closes an eye."""

import numpy as np

from toongeo.pipeline.rig.lid_rings import LidRings, along, at_shares

OPEN = 0.02  # of the opening's width: lids that are apart by less are shut


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
    before, after = (float(opening_gaps(rings, V, across).max()) for V in (neutral, blink))
    width = float(np.linalg.norm(neutral[rings.upper[0, -1]] - neutral[rings.upper[0, 0]]))
    return 100.0 * (1 - min(1.0, max(0.0, after) / max(before, OPEN * width)))


def opening_gaps(rings: LidRings, V: np.ndarray, across: np.ndarray) -> np.ndarray:
    """How far, in mm, the edge of the upper lid is above that of the lower one; negative where it hangs over it."""
    upper, lower = V[rings.upper[0]], V[rings.lower[0]]
    return np.asarray((upper - at_shares(along(upper), along(lower), lower)) @ across)


def across_opening(rings: LidRings, V: np.ndarray) -> np.ndarray:
    """Unit vector (3,) in the plane of the lids' edges, from the lower to the upper lid."""
    points = V[rings.vertices]
    plane = np.linalg.svd(points - points.mean(0), full_matrices=False)[2][2]
    across = np.cross(plane, V[rings.upper[0, -1]] - V[rings.upper[0, 0]])
    up = (V[rings.upper[2]].mean(0) - V[rings.lower[2]].mean(0)) @ across
    return np.asarray(across * np.sign(up or 1.0) / np.linalg.norm(across))
