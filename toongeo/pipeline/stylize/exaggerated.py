"""What is special about a face, as displacements of its landmarks."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit import FaceFit

__all__ = ["exaggerated"]

# Landmarks by which the mean face is laid on this one: those inside the face, and most of the jaw.
_LAID = (*range(27, 31), *range(36, 48), *range(17, 27), *range(48, 68), *range(3, 14))


def exaggerated(landmarks: Floats, fit: FaceFit) -> Floats:
    """Displacements (68, 2) px from the mean face to this one: what a caricature has more of (Brennan 1985).

    The mean face has this one's pose and expression, and is laid on it by a similarity (least squares, as complex
    numbers), so that only what is special about the identity is left.
    """
    model = fit.model
    mean = fit.camera.project(model.vertices(np.zeros_like(fit.identity), fit.expression)[fit.landmark_vertices])
    laid = list(_LAID)
    centre, goal = mean[laid].mean(axis=0), landmarks[laid].mean(axis=0)
    a = (mean - centre) @ [1, 1j]
    b = (landmarks - goal) @ [1, 1j]
    turn = np.vdot(a[laid], b[laid]) / np.vdot(a[laid], a[laid]).real
    difference = b - turn * a
    return np.stack([difference.real, difference.imag], axis=1)
