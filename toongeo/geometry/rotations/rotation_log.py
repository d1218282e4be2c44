"""Rotation vectors of rotation matrices, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

__all__ = ["rotation_log"]

_NEAR_PI = -0.99  # cosine below which the antisymmetric part no longer tells the axis


def rotation_log(R: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors (3, n) along the axes of rotations (3, 3, n), as long as the angles in [0, pi], radians.

    ``[w]x`` is the matrix logarithm of Wu et al. 2018, Eq. 2. Of the two vectors of a half turn either may come.

    Parameters
    ----------
    R : (3, 3, n) float
        Rotations; not checked.

    Returns
    -------
    (3, n) float64, radians

    Examples
    --------
    >>> rotation_log(np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])[:, :, None])[:, 0].round(12)
    array([0.        , 0.        , 1.57079633])
    """
    w = np.stack([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = 0.5 * np.sqrt((w * w).sum(axis=0))
    cosine = 0.5 * (R[0, 0] + R[1, 1] + R[2, 2] - 1)
    small = sine < 1e-8
    w *= np.where(small, 0.5, 0.5 * np.arctan2(sine, cosine) / np.where(small, 1.0, sine))
    turned = np.flatnonzero(cosine < _NEAR_PI)
    if len(turned):
        w[:, turned] = Rotation.from_matrix(R[:, :, turned].transpose(2, 0, 1)).as_rotvec().T
    return w
