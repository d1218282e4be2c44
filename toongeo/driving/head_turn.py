"""How a take turns the head."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from toongeo.arrays import Floats

__all__ = ["head_quaternions", "head_rotation"]


def head_rotation(angles: ArrayLike) -> Floats:
    """Rotation (3, 3) in the model frame of yaw, pitch and roll (3,), radians.

    As ARKit tells how a face is held: right-handed about the axes of the face, ``Ry(yaw) Rx(pitch) Rz(roll)``. Yaw > 0
    turns it to the subject's left, pitch > 0 nods it down, roll > 0 tilts it counter-clockwise in the image.

    Parameters
    ----------
    angles : (3,) float, radians
        Yaw, pitch and roll.

    Returns
    -------
    (3, 3) float64

    Raises
    ------
    ValueError
        If they are not three finite numbers.

    Examples
    --------
    >>> (head_rotation([np.pi / 2, 0, 0]) @ [0, 0, 1]).round(6).tolist()  # the nose points to the subject's left
    [1.0, 0.0, 0.0]
    """
    return np.asarray(_rotations(np.asarray(angles, np.float64).reshape(1, -1)).as_matrix()[0])


def head_quaternions(angles: ArrayLike) -> Floats:
    """The same for frames (f, 3), as unit quaternions (f, 4) x, y, z, w without jumps of sign.

    Parameters
    ----------
    angles : (f, 3) float, radians
        Yaw, pitch and roll of each frame.

    Returns
    -------
    (f, 4) float64
        Of length 1.

    Raises
    ------
    ValueError
        If they are not finite, or not three a frame.

    Examples
    --------
    >>> head_quaternions([[0, 0, 0], [0, np.pi, 0]]).round(6).tolist()
    [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]]
    """
    quaternions = np.asarray(_rotations(np.asarray(angles, np.float64)).as_quat(canonical=True))
    turned = (quaternions[1:] * quaternions[:-1]).sum(axis=1) < 0
    signs = np.cumprod(np.r_[1.0, np.where(turned, -1.0, 1.0)])
    return quaternions * signs[:, None]


def _rotations(angles: Floats) -> Rotation:
    if angles.ndim != 2 or angles.shape[1] != 3 or not np.isfinite(angles).all():
        raise ValueError(f"angles: expected finite yaw, pitch and roll, got shape {angles.shape}")
    return Rotation.from_euler("YXZ", angles)
