"""Least-squares similarity between two point sets."""

import numpy as np

from toongeo.geometry.rotations.nearest_rotation import nearest_rotation

__all__ = ["similarity"]


def similarity(source: np.ndarray, target: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Scale, rotation and shift that bring points onto their partners in the least-squares sense (Umeyama 1991).

    Parameters
    ----------
    source, target : (k, 3) float, any common unit
        Row i of one belongs to row i of the other; k >= 3, not all on a line.

    Returns
    -------
    scale : float
    rotation : (3, 3) float64, determinant +1
    shift : (3,) float64
        ``target`` is about ``scale * source @ rotation.T + shift``.

    Examples
    --------
    >>> points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]])
    >>> scale, rotation, shift = similarity(points, 2 * points + [1, 2, 3])
    >>> round(scale, 12), np.allclose(rotation, np.eye(3)), shift.round(12)
    (2.0, True, array([1., 2., 3.]))
    """
    centre_source, centre_target = source.mean(0), target.mean(0)
    A, B = source - centre_source, target - centre_target
    M = B.T @ A
    rotation = nearest_rotation(M)
    scale = float((rotation * M).sum() / (A**2).sum())
    return scale, rotation, centre_target - scale * rotation @ centre_source
