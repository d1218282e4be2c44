"""A filter that follows the edges of another picture."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.arrays import Singles

__all__ = ["guided_filter"]

_SINGULAR = np.float32(1e-6)  # below this determinant a window counts as of one colour


def guided_filter(guide: Singles, plane: Singles, radius: int, softness: float) -> Singles:
    """Filter a plane so that it is an affine function of the guide's colours in every window (He et al. 2013, 3.6).

    Means are box filters over windows that are mirrored at the picture's border. In a window whose colours hardly vary
    (the determinant of their covariance plus softness is below 1e-6) the plane's mean is taken. Both are as in
    ``ximgproc.guidedFilter``, which not every build of OpenCV has: this gives the same float32 numbers, but for the
    last bits in the last columns.

    Parameters
    ----------
    guide
        (h, w, 3) float32, in [0, 1].
    plane
        (h, w) float32.
    radius
        Of a window of side 2 radius + 1, px.
    softness
        The paper's epsilon, squared colour differences: edges much weaker than its root are not followed.

    Returns
    -------
    (h, w) float32

    Examples
    --------
    >>> guide = np.zeros((5, 6, 3), np.float32)
    >>> guide[:, 3:] = 1  # a constant plane stays as it is
    >>> bool(np.allclose(guided_filter(guide, np.full((5, 6), 0.25, np.float32), 2, 1e-3), 0.25))
    True
    """
    colours = [np.ascontiguousarray(guide[:, :, channel]) for channel in range(3)]
    means = [_box(colour, radius) for colour in colours]
    mean = _box(plane, radius)
    inverse = _inverse(_covariances(colours, means, radius, np.float32(softness)))
    with_plane = [_box(plane * colour, radius) - mean * m for colour, m in zip(colours, means, strict=True)]
    slopes = [_combined(row, with_plane) for row in inverse]  # Eq. 19
    offset = mean  # Eq. 20
    for slope, m in zip(slopes, means, strict=True):
        offset = offset - slope * m
    result = _box(offset, radius)  # Eq. 21
    for slope, colour in zip(slopes, colours, strict=True):
        result = result + _box(slope, radius) * colour
    return result


def _box(plane: Singles, radius: int) -> Singles:
    side = 2 * radius + 1
    return np.asarray(cv2.boxFilter(plane, cv2.CV_32F, (side, side), borderType=cv2.BORDER_REFLECT), np.float32)


def _covariances(
    colours: list[Singles], means: list[Singles], radius: int, softness: np.float32
) -> dict[tuple[int, int], Singles]:
    """Of the guide's channels in every window; the softness is added to the variances."""
    found = {}
    for i in range(3):
        for j in range(i + 1):
            square = _box(colours[i] * colours[j], radius)
            square = square + softness if i == j else square
            found[i, j] = found[j, i] = square - means[i] * means[j]
    return found


def _inverse(matrix: dict[tuple[int, int], Singles]) -> list[list[Singles]]:
    """Of symmetric 3 x 3 matrices, by their cofactors: rows of planes."""

    def cofactor(i: int, j: int) -> Singles:
        (a, b), (c, d) = (((i + 1) % 3, (i + 2) % 3), ((j + 1) % 3, (j + 2) % 3))
        return matrix[a, c] * matrix[b, d] - matrix[a, d] * matrix[b, c]

    cofactors = [[cofactor(max(i, j), min(i, j)) for j in range(3)] for i in range(3)]
    determinant = _combined([matrix[i, 0] for i in range(3)], cofactors[0])
    determinant[np.abs(determinant) < _SINGULAR] = 1
    return [[plane / determinant for plane in row] for row in cofactors]


def _combined(factors: list[Singles], planes: list[Singles]) -> Singles:
    """Sum of products of planes."""
    first, second, third = (factor * plane for factor, plane in zip(factors, planes, strict=True))
    return (first + second) + third
