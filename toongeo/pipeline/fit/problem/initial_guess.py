"""Where a landmark fit begins, and what it may not leave."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.frame.canonical_frame import CanonicalFrame
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.landmarks.robust_weights import SETTLED, robust_weights
from toongeo.protocols import Coefficients

__all__ = ["held_bounds", "likeliest", "posing_weight", "principal_point_of", "start_vector"]

_FLIP = np.array([1.0, -1.0])
_POSING_PASSES = 4  # of pose and robust weights in turn


def likeliest(model: MorphableModel, unknowns: Unknowns) -> Floats:
    """Unknowns (n,) of the likeliest face without expression, in the frame of its pose."""
    x = np.zeros(unknowns.size)
    if model.prior is not None:
        x[unknowns.identity] = model.prior.mean
    return x


def start_vector(guess: Coefficients, unknowns: Unknowns, expected: Floats) -> Floats:
    """Unknowns (n,) at a guess, in the frame of its pose; what it does not tell is expected."""
    x = expected.copy()
    for name, value in (("identity", guess.identity), ("expression", guess.expression)):
        where = getattr(unknowns, name)
        if value is None:
            continue
        if value.shape != x[where].shape:
            raise ValueError(f"regressor: expected {name} of shape {x[where].shape}, got {value.shape}")
        x[where] = value
    return x


def held_bounds(
    bounds: tuple[Floats, Floats], start: Floats, unknowns: Unknowns, pose_too: bool
) -> tuple[Floats, Floats]:
    """Bounds that leave only the pose free, or nothing."""
    held = slice(None) if pose_too else unknowns.shape
    lower, upper = (bound.copy() for bound in bounds)
    lower[held] = upper[held] = start[held]
    return lower, upper


def posing_weight(points: Floats, pixels: Floats, options: FitOptions) -> Floats:
    """Robust weights (k,) of the points that fix the first pose, from the misfit of the likeliest face."""
    robust_weight = np.ones(len(points))
    for _ in range(_POSING_PASSES if options.robust else 0):
        scale, rotation, translation = scaled_orthographic_pose(points, pixels, robust_weight)
        seen = scale * points @ rotation[:2].T * _FLIP + translation
        squares = ((seen - pixels) ** 2).sum(axis=1)
        before, robust_weight = robust_weight, robust_weights(squares, options.robust, 0.0)
        if np.abs(robust_weight - before).max() <= SETTLED:
            break
    return robust_weight


def principal_point_of(options: FitOptions, image_centre: Floats | None, frame: CanonicalFrame) -> Floats:
    """The given one, or the middle of the picture, or that of the face when there is no picture, px."""
    if options.principal_point is not None:
        return np.array(options.principal_point, np.float64)
    return frame.origin if image_centre is None else image_centre
