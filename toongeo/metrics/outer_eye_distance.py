"""The unit of landmark errors."""

import numpy as np

from toongeo.metrics.landmark_error import OUTER_EYES

__all__ = ["outer_eye_distance"]


def outer_eye_distance(landmarks: np.ndarray, found: np.ndarray) -> float:
    """Distance of the outer eye corners, px, of landmarks (68, 2); corners that are NaN are taken from ``found``."""
    right, left = np.where(np.isfinite(landmarks), landmarks, found)[list(OUTER_EYES)]
    return float(np.linalg.norm(left - right))
