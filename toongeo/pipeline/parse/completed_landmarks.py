"""Landmarks without gaps."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats
from toongeo.model.default_model import default_model
from toongeo.protocols import FittedFace

__all__ = ["completed_landmarks"]


def completed_landmarks(landmarks: Floats, fit: FittedFace) -> Floats:
    """Landmarks (68, 2) px with the missing ones where the fitted face has them."""
    missing = np.isnan(landmarks[:, 0])
    if not missing.any():
        return landmarks
    vertices = getattr(fit, "landmark_vertices", default_model().landmarks)
    points = landmarks.copy()
    points[missing] = fit.camera.project(fit.vertices[vertices[missing]])
    return points
