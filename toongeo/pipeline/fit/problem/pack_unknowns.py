"""A finished fit as a vector of unknowns."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from toongeo.arrays import Floats
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.problem.landmark_problem import LandmarkProblem

__all__ = ["pack_unknowns"]


def pack_unknowns(fit: FaceFit, landmarks: LandmarkProblem) -> Floats:
    """The vector of a fit in the frame of its landmark problem; inverse of `CanonicalFrame.camera`."""
    u, frame = landmarks.unknowns, landmarks.frame
    x = np.zeros(u.size)
    x[u.identity], x[u.expression] = fit.identity, fit.expression
    origin = np.zeros((1, 3))
    rotation = (fit.camera.view(np.eye(3)) - fit.camera.view(origin)).T
    scale = np.sqrt((fit.camera.jacobian(origin) ** 2).sum() / 2)  # |s P R|^2 = 2 s^2
    x[u.rotation] = Rotation.from_matrix(frame.roll.T @ rotation @ frame.rotation0.T).as_rotvec()
    x[u.log_scale] = np.log(scale / frame.scale)
    x[u.translation] = frame.from_pixels(fit.camera.project(origin))[0]
    return x
