"""A large texture from small patches."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["quilted"]

Floats = NDArray[np.floating]
# A patch is taken whose error is above the best one's by at most so much of that, and of the mean one: with less, the
# plainest patch beside itself always fits best.
_TOLERANCE, _SPREAD = 0.2, 0.07


def quilted(
    patches: NDArray[np.float32], shape: tuple[int, int], overlap: int, rng: np.random.Generator
) -> NDArray[np.float32]:
    """Image quilting (Efros and Freeman 2001): patches side by side, cut where they differ least.

    Parameters
    ----------
    patches : (k, b, b, c) float32
    shape : (rows, columns)
        Of the texture.
    overlap : int
        Pixels by which neighbours overlap, below b.
    rng : Generator
        Chooses among patches that fit about as well.

    Returns
    -------
    (rows, columns, c) float32

    Examples
    --------
    >>> one = np.ones((1, 6, 6, 1), np.float32)
    >>> texture = quilted(one, (10, 17), 2, np.random.default_rng(0))
    >>> texture.shape, float(texture.min())
    ((10, 17, 1), 1.0)
    """
    side, step = patches.shape[1], patches.shape[1] - overlap
    rows, columns = (-(-(n - overlap) // step) for n in shape)
    texture = np.zeros((rows * step + overlap, columns * step + overlap, patches.shape[3]), np.float32)
    parts = (part.reshape(len(patches), -1) for part in (patches[:, :overlap], patches[:, :, :overlap]))
    upper, left = ((part, np.einsum("km,km->k", part, part)) for part in parts)
    for i in range(rows):
        for j in range(columns):
            place = texture[i * step : i * step + side, j * step : j * step + side]
            errors = np.zeros(len(patches), np.float32)
            if i:
                errors += _distances(*upper, place[:overlap])
            if j:
                errors += _distances(*left, place[:, :overlap])
            bound = errors.min() + _TOLERANCE * errors.min() + _SPREAD * errors.mean()
            chosen = patches[rng.choice(np.flatnonzero(errors <= bound))]
            kept = np.zeros((side, side), bool)  # of what is there already
            if i:
                difference = ((chosen[:overlap] - place[:overlap]) ** 2).sum(2)
                kept[:overlap] |= np.arange(overlap)[:, None] < _cut(difference.T)
            if j:
                difference = ((chosen[:, :overlap] - place[:, :overlap]) ** 2).sum(2)
                kept[:, :overlap] |= np.arange(overlap) < _cut(difference)[:, None]
            place[~kept] = chosen[~kept]
    return texture[: shape[0], : shape[1]]


def _distances(
    rows: NDArray[np.float32], squares: NDArray[np.float32], place: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Squared distances (k,) of rows (k, m), whose squared lengths are given, to a place of m numbers."""
    goal = place.ravel()
    return np.asarray(np.maximum(squares - 2 * (rows @ goal) + goal @ goal, 0), np.float32)


def _cut(difference: Floats) -> NDArray[np.int64]:
    """Column in each row of the path from the first row to the last along which the sum is least."""
    rows, columns = difference.shape
    total = np.full((rows, columns + 2), np.inf)
    total[:, 1:-1] = difference
    least = np.empty(columns)
    for row in range(1, rows):
        above = total[row - 1]
        np.minimum(above[:-2], above[1:-1], out=least)
        np.minimum(least, above[2:], out=least)
        total[row, 1:-1] += least
    path, sums = [int(total[-1].argmin())], total.tolist()
    for row in range(rows - 2, -1, -1):
        near = sums[row][path[-1] - 1 : path[-1] + 2]
        path.append(path[-1] - 1 + near.index(min(near)))
    return np.array(path[::-1]) - 1
