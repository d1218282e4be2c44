"""Closed-form pose of known 3D points in a picture."""

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.operators.cross import cross

__all__ = ["scaled_orthographic_pose"]

_FLATTEST = 1e-3  # smallest ratio of the two image axes of an affine camera that is taken for a face
_FLIP = np.array([1.0, -1.0])


def scaled_orthographic_pose(
    points: NDArray[np.float64], pixels: NDArray[np.float64], weights: NDArray[np.float64] | None = None
) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Scale, rotation and translation of the camera that sees ``points`` nearly at ``pixels``.

    The affine camera of least squared error is linear; the scaled orthographic camera nearest to its 2 x
    3 matrix follows from the singular value decomposition: with ``M = U diag(s) V^T`` the two rows of the
    rotation are ``U V^T`` (orthogonal Procrustes) and the scale is the mean of ``s``.

    Parameters
    ----------
    points : (k, 3) float, mm, model frame
        At least four, not in one plane.
    pixels : (k, 2) float, px (x right, y down)
    weights : (k,) float >= 0, optional
        Of the squared errors; all alike if None.

    Returns
    -------
    scale : float, px/mm
    rotation : (3, 3), model to camera frame, determinant +1
    translation : (2,), px

    Raises
    ------
    ValueError
        If the pixels lie on a line (or in a point), so that nothing fixes the pose.

    References
    ----------
    P. H. Schönemann, "A generalized solution of the orthogonal Procrustes problem", Psychometrika 31, 1966.
    As the first pose of a morphable model: A. Bas, W. Smith, T. Bolkart, S. Wuhrer, "Fitting a 3D morphable
    model to edges", ACCV workshops 2016.
    """
    upright = pixels * _FLIP
    w = np.ones(len(points)) if weights is None else weights
    centre3, centre2 = w @ points / w.sum(), w @ upright / w.sum()
    root = np.sqrt(w)[:, None]
    M = np.linalg.lstsq(root * (points - centre3), root * (upright - centre2), rcond=None)[0].T
    U, s, Vt = np.linalg.svd(M, full_matrices=False)
    if not s[1] > _FLATTEST * s[0]:
        raise ValueError(
            "landmarks: expected points spread over a face, got points on a line "
            f"(extent {np.ptp(pixels[:, 0]):.4g} x {np.ptp(pixels[:, 1]):.4g} px)"
        )
    rows = U @ Vt
    rotation = np.vstack([rows, cross(rows[:1].T, rows[1:].T).T])
    scale = float(s.mean())
    translation = (centre2 - scale * rows @ centre3) * _FLIP
    return scale, rotation, translation
