"""The rotation nearest to a matrix."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread

__all__ = ["nearest_rotation"]


def nearest_rotation(M: Floats) -> Floats:
    """Rotation R (3, 3) that maximises ``tr(R^T M)``: with M = sum_i q_i p_i^T the best turn of p onto q (Kabsch 1976).

    With ``M = U diag(s) V^T`` it is ``U diag(1, 1, det(U V^T)) V^T``; no reflection, however M turns space inside out.

    Examples
    --------
    >>> nearest_rotation(np.diag([1.0, 2.0, -0.1])).round(12) + 0.0
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    with one_thread():
        U, _, Vt = np.linalg.svd(M)
        return np.asarray((U * [1.0, 1.0, np.sign(np.linalg.det(U @ Vt))]) @ Vt)
