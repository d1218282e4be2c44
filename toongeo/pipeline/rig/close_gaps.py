"""Blinks that leave no gap on a registered face."""

import numpy as np

from toongeo.geometry import laplacian_align
from toongeo.model import MorphableModel
from toongeo.pipeline.align.carry_inner_parts import opening_rim
from toongeo.pipeline.align.rim_anchors import rim_path

WEIGHT = 1e3  # of the anchors: they are met to about a hundredth of a millimetre
OVERLAP = 0.02  # of an eye's width: how far an upper lid comes down over the lower one, at least


def close_gaps(model: MorphableModel, neutral: np.ndarray, closed: np.ndarray, side: str) -> np.ndarray:
    """Bring the upper lid down where a blink has left it above the lower one.

    Transfer keeps rotations and stretches, not contacts: eyes taller than the template's stay open. A lid that lies over
    the other already, like a tile, is left as it is.

    Parameters
    ----------
    model : MorphableModel
    neutral, closed : (n, 3) float64, mm, model frame
        The face at rest and with the eye of one side closed as far as the transfer closes it.
    side : {"left", "right"}

    Returns
    -------
    (n, 3) float64
        ``closed``, corrected around that eye; itself if there is no gap.
    """
    upper, lower = (rim_path(model, f"lid_{lid}_{side}") for lid in ("upper", "lower"))
    up = neutral[upper].mean(0) - neutral[lower].mean(0)
    up /= np.linalg.norm(up)
    # Both rims run from corner to corner: partners are at one place across the eye.
    across = neutral[upper[-1]] - neutral[upper[0]]
    width = float(np.linalg.norm(across))
    across /= width
    order = np.argsort(closed[lower] @ across, kind="stable")
    place = closed[lower][order] @ across
    landing = np.stack([np.interp(closed[upper] @ across, place, closed[lower][order, a]) for a in range(3)], axis=1)
    height = (closed[upper] - landing) @ up + OVERLAP * width
    inner = np.arange(len(upper))[1:-1]
    short = inner[height[inner] > OVERLAP * width * 0.5]
    if not len(short):
        return closed
    socket = f"socket_{side}"
    around = model.region(f"eye_{side}") | (model.region(socket) if socket in model.regions else False)
    patch = around[model.faces].all(1)
    used, local = np.unique(model.faces[patch], return_inverse=True)
    still = np.union1d(np.intersect1d(used, model.faces[~patch]), lower)
    moving = np.setdiff1d(upper, still)
    drop = np.zeros(len(closed))
    drop[upper[inner]] = np.maximum(height[inner], 0.0)
    targets = closed[moving] - drop[moving, None] * up
    result = closed.copy()
    shift = laplacian_align(
        closed[used],
        local.reshape(-1, 3),
        np.searchsorted(used, np.r_[still, moving]),
        np.vstack([closed[still], targets]),
        weight=WEIGHT,
    )
    result[used] = shift
    return result
