"""Where hair grows on a head."""

import numpy as np
from numpy.typing import NDArray

from toongeo.model import MorphableModel

__all__ = ["above_nape"]


def above_nape(model: MorphableModel) -> NDArray[np.bool_]:
    """Vertices (n,) of the scalp above a line from the ears' upper front down to the nape, on the mean face."""
    mean, regions = model.mean, model.regions
    ears, scalp = mean[regions["ears"]], mean[regions["scalp"]]
    front, back = ears[:, 2].max(), scalp[:, 2].min()
    top, low = ears[:, 1].max(), ears[:, 1].min() - 0.6 * np.ptp(ears[:, 1])
    line = top + (low - top) * (front - mean[:, 2]) / (front - back)
    return np.asarray(regions["scalp"] & (mean[:, 1] > line))
