"""A field that is known in a part of a picture, carried on smoothly over the rest."""

import cv2
import numpy as np

__all__ = ["spread_field"]


def spread_field(field: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Fill a field where it is not known from where it is, nearby places first (pull and push over a pyramid).

    Parameters
    ----------
    field : (h, w, c) float32
    known : (h, w) bool
        Where the field is kept as it is.

    Returns
    -------
    (h, w, c) float32
        All 0 where nothing is known anywhere.

    Examples
    --------
    >>> field, known = np.zeros((8, 8, 1), np.float32), np.zeros((8, 8), bool)
    >>> field[:, 0], known[:, 0] = 3.0, True
    >>> bool(np.allclose(spread_field(field, known), 3.0))
    True
    """
    weight = known.astype(np.float32)
    levels = [(np.asarray(field * weight[..., None], np.float32), weight)]
    while min(levels[-1][1].shape) > 1 and levels[-1][1].min() < 1:
        total, count = (_halved(part) for part in levels[-1])
        levels.append((_channels(total), count))
        # A pixel that has some known ones beneath it counts as known, by so much.
        scale = 1 / np.maximum(count, 1)
        levels[-1] = (levels[-1][0] * scale[..., None], count * scale)
    coarse = _mean(*levels[-1])
    for total, weight in levels[-2::-1]:
        size = weight.shape[1], weight.shape[0]
        above = _channels(cv2.resize(coarse, size, interpolation=cv2.INTER_LINEAR))
        coarse = total + (1 - weight)[..., None] * above
    return np.asarray(coarse)


def _halved(part: np.ndarray) -> np.ndarray:
    """Half as large; sums over 2 x 2 pixels, spread a little, so that one known pixel of four suffices."""
    height, width = part.shape[:2]
    size = (width + 1) // 2, (height + 1) // 2
    return np.asarray(4 * cv2.resize(part, size, interpolation=cv2.INTER_AREA), np.float32)


def _channels(part: np.ndarray) -> np.ndarray:
    return part if part.ndim == 3 else part[..., None]


def _mean(total: np.ndarray, weight: np.ndarray) -> np.ndarray:
    return total / np.maximum(weight, 1e-6)[..., None]
