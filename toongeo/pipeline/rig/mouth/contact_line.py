"""Where the lips of a mouth that is drawn open meet when it closes.

Constants were chosen with `closed_mouth` (``benchmarks/mouths.py``).
"""

import numpy as np

from toongeo.geometry.polyline import arc_length, arc_shares, interpolated
from toongeo.model.anatomy.lip_line import LipLine

__all__ = ["contact_line"]

_PHILTRUM = 0.3  # of the upper lip's height: by so much it comes down; jaws close mouths, upper lips hardly do
_UPPER_SHARE = (0.05, 0.4)  # of the way to the lower lip that the upper one goes at least and at most
_ARCH = 0.03  # of the mouth's width: a line that arches more above its corners would be a frown; they are lifted
_SHORTEST, _WIDEST = 0.7, 1.3  # of the longer lip that the line is at least; how much wider the mouth may get for that
_ARCS = 3  # polynomials that vanish at the corners: an arc, one that leans, one that is flat amid; more are waves
_GAP = 0.004  # of the mouth's width, left between the lips: what touches counts as crossing
_CORNER = 0.04  # of the line: where the gap has grown to its full size; nearer to the corners lips cross in a smile


def contact_line(line: LipLine, V: np.ndarray, up: np.ndarray, philtrum: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacements of both lips that bring them together at one line.

    The line runs between the lips, near the upper one, at their mean depth. What a smile is in it stays. A round mouth
    becomes a wider one, so that its lips are not squeezed.

    Parameters
    ----------
    line : LipLine
    V : (n, 3) float, mm
    up : (3,) float
        Unit vector across the mouth.
    philtrum : float, mm
        From the nose to the upper lip.

    Returns
    -------
    (u, 3), (l, 3) float64, mm
        Of ``line.upper`` and ``line.lower``, corners included.
    """
    upper, lower = V[line.upper], V[line.lower]
    at_upper, at_lower = arc_shares(upper), arc_shares(lower)
    s = np.union1d(at_upper, at_lower)
    above, below = interpolated(s, at_upper, upper), interpolated(s, at_lower, lower)
    apart = float(np.linalg.norm(above - below, axis=1).max())
    share = np.clip(_PHILTRUM * philtrum / max(apart, 1e-9), *_UPPER_SHARE)
    contact = above + share * (below - above)
    contact[:, 2] = (above[:, 2] + below[:, 2]) / 2
    contact += _faired(s, contact @ up)[:, None] * up
    axis = upper[-1] - upper[0]
    width = float(np.linalg.norm(axis))
    ends = (contact[0] + contact[-1]) / 2
    arch = (interpolated(np.array([0.5]), s, contact)[0] - ends) @ up
    contact += max(0.0, arch - _ARCH * width) * ((2 * s - 1) ** 2)[:, None] * up
    longest = max(arc_length(path)[-1] for path in (above, below))
    widen = np.clip(_SHORTEST * longest / max(arc_length(contact)[-1], 1e-9), 1, _WIDEST) - 1
    ends = (contact[0] + contact[-1]) / 2
    contact += widen * np.outer((contact - ends) @ axis, axis) / width**2
    half = _GAP / 2 * width * np.minimum(1, np.minimum(s, 1 - s) / _CORNER)[:, None] * up
    return interpolated(at_upper, s, contact + half) - upper, interpolated(at_lower, s, contact - half) - lower


def _faired(s: np.ndarray, height: np.ndarray) -> np.ndarray:
    """What lacks to heights (k,) along a line, at places in [0, 1], to lie on the nearest plain arc with their ends."""
    chord = height[0] + s * (height[-1] - height[0])
    arcs = (s * (1 - s))[:, None] * (2 * s[:, None] - 1) ** np.arange(_ARCS)
    step = np.gradient(s)[:, None] ** 0.5  # so that what is sampled densely does not count more
    share = np.linalg.lstsq(step * arcs, step[:, 0] * (height - chord), rcond=None)[0]
    return np.asarray(chord + arcs @ share - height)
