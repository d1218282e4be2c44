"""The rotation that best lays one set of points onto another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread


def rigid_rotation(P: NDArray[np.float64], Q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation R (3, 3) for which ``P @ R.T`` comes nearest to Q (k, 3), up to a translation (Kabsch)."""
    with one_thread():
        U, _, Vt = np.linalg.svd((Q - Q.mean(axis=0)).T @ (P - P.mean(axis=0)))
        return np.asarray((U * [1.0, 1.0, np.sign(np.linalg.det(U @ Vt))]) @ Vt)
