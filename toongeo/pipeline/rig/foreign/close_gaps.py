"""Blinks that leave no gap on a registered face.

Constants were judged on ICT-FaceKit's head and the template (``benchmarks/register.py``), on no picture.
"""

import numpy as np

from toongeo.geometry import laplacian_align
from toongeo.model import MorphableModel
from toongeo.model.anatomy.rims import rim_path

__all__ = ["close_gaps"]

_OVERLAP = 0.5  # of the model's: how far an upper lid comes down over the lower one, at least
_EVEN = 1e-3  # of an eye's width: a gap that is left alone


def close_gaps(model: MorphableModel, neutral: np.ndarray, closed: np.ndarray, side: str) -> np.ndarray:
    """Bring the upper lid down where a blink has left it too high over the lower one.

    Transfer keeps rotations and stretches, not contacts: eyes taller than the model's stay open. On the model the upper
    lid comes to lie over the lower one, like a tile; here it does so at least half as far, in widths of the eye. Where
    it does already it is left as it is.

    Parameters
    ----------
    model : MorphableModel
        With the expressions ``eyeBlinkLeft`` and ``eyeBlinkRight``.
    neutral, closed : (n, 3) float64, mm, model frame
        The face at rest, and with the eye of one side closed as far as the transfer closes it.
    side : {"left", "right"}

    Returns
    -------
    (n, 3) float64
        ``closed``, with the skin around that eye corrected.
    """
    blink = model.expression[model.expression_index(f"eyeBlink{side.capitalize()}")]
    upper, lower = (rim_path(model, f"lid_{lid}_{side}") for lid in ("upper", "lower"))
    wanted, _, width = _heights(model.mean, model.mean + blink, upper, lower)
    found, up, own_width = _heights(neutral, closed, upper, lower)
    drop = np.maximum(found - _OVERLAP * np.minimum(wanted, 0.0) * own_width / width, 0.0)
    drop[[0, -1]] = 0.0  # the corners, which the lids share
    if drop.max() <= _EVEN * own_width:
        return closed
    around = model.region(f"eye_{side}").copy()
    if f"socket_{side}" in model.regions:
        around |= model.region(f"socket_{side}")
    patch = around[model.faces].all(1)
    used, local = np.unique(model.faces[patch], return_inverse=True)
    still = np.union1d(np.intersect1d(used, model.faces[~patch]), lower)
    moving = ~np.isin(upper, still)
    targets = closed[upper[moving]] - drop[moving, None] * up
    result = closed.copy()
    result[used] = laplacian_align(
        closed[used],
        local.reshape(-1, 3),
        np.searchsorted(used, np.r_[still, upper[moving]]),
        np.vstack([closed[still], targets]),
        weight=np.inf,
    )
    return result


def _heights(
    neutral: np.ndarray, closed: np.ndarray, upper: np.ndarray, lower: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """How high (k,) each vertex of the upper rim stays above the lower one, the direction up, and the eye's width.

    Up is where the open lids are apart; partners are at one place across the eye.
    """
    across = neutral[upper[-1]] - neutral[upper[0]]
    width = float(np.linalg.norm(across))
    across = across / width
    up = neutral[upper].mean(0) - neutral[lower].mean(0)
    up = up / np.linalg.norm(up)
    order = np.argsort(closed[lower] @ across, kind="stable")
    landing = np.interp(closed[upper] @ across, (closed[lower] @ across)[order], (closed[lower] @ up)[order])
    return closed[upper] @ up - landing, up, width
