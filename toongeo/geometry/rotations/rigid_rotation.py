"""The rotation that best lays one set of points onto another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.rotations.nearest_rotation import nearest_rotation

__all__ = ["rigid_rotation"]


def rigid_rotation(P: NDArray[np.float64], Q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation R (3, 3) for which ``P @ R.T`` comes nearest to Q (k, 3), up to a translation (Kabsch)."""
    with one_thread():
        return nearest_rotation((Q - Q.mean(axis=0)).T @ (P - P.mean(axis=0)))
