"""All landmarks from a few."""

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats, Mask
from toongeo.io import landmark_array
from toongeo.model import default_model
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.align.symmetric_field import FieldPrior, most_likely_field
from toongeo.pipeline.fit import fit_3dmm

__all__ = ["FEWEST_CLICKS", "place_landmarks"]

FEWEST_CLICKS = 2  # fix place, size and tilt
_FEWEST_FITTED = 6  # what a fit asks for
_LEAST_PX = 1.0  # clicks nearer to each other are one
# The affine part is a quarter of that in the alignment, where more points are known: on the example pictures three
# clicks leave 10.3 % of the outer-eye distance, not 11.3 %, and from six on nothing changes.
_PRIOR = FieldPrior(linear=1.0)


def place_landmarks(clicks: ArrayLike) -> Floats:
    """The 68 landmarks of the likeliest face through those that are known.

    From six points on the morphable model is fitted to them, below that its mean is laid onto them by a similarity.
    What the face misses is spread to the other points by the Gaussian process of the alignment's flow.

    Parameters
    ----------
    clicks : (68, 2) array_like, px
        NaN rows are not known.

    Returns
    -------
    (68, 2) float64 px
        Known points as they are; the others by estimate, a start for corrections.

    Raises
    ------
    ValueError
        If fewer than two points are known, they coincide, or no face has six of them there.

    Examples
    --------
    >>> clicks = np.full((68, 2), np.nan)
    >>> clicks[36], clicks[45], clicks[8] = (100, 100), (200, 100), (150, 230)
    >>> bool(140 < place_landmarks(clicks)[30, 0] < 160)
    True
    """
    points = landmark_array(clicks, "clicks")
    known = np.isfinite(points[:, 0])
    if known.sum() < FEWEST_CLICKS:
        raise ValueError(f"clicks: expected at least {FEWEST_CLICKS} known points, got {known.sum()}")
    face, seen, jacobians = _fitted(points) if known.sum() >= _FEWEST_FITTED else _mean(points, known)
    unit = float(np.linalg.norm(np.subtract(*face[list(OUTER_EYES)])))
    jacobians = jacobians * unit
    px = np.sqrt((jacobians[known] ** 2).mean() * 3)  # of a unit across the view
    missed = (points - seen)[known] / px
    field = most_likely_field(face / unit, face[known] / unit, jacobians[known] / px, missed, _PRIOR)
    placed = seen + np.einsum("kac,kc->ka", jacobians, field)
    placed[known] = points[known]
    return placed


def _fitted(points: Floats) -> tuple[Floats, Floats, Floats]:
    """Landmarks of the fitted face in mm and in px, and the camera's Jacobians there."""
    fit = fit_3dmm(None, points)
    face = fit.vertices[fit.landmark_vertices]
    return face, fit.project(face), fit.camera.jacobian(face)


def _mean(points: Floats, known: Mask) -> tuple[Floats, Floats, Floats]:
    """The same of the mean face, seen from the front; places are complex numbers, with y down as in pictures."""
    model = default_model()
    face = model.mean[model.landmarks]
    plane, wanted = face[:, 0] - 1j * face[:, 1], points @ [1, 1j]
    middle, wanted_middle = plane[known].mean(), wanted[known].mean()
    source, target = plane[known] - middle, wanted[known] - wanted_middle
    turn = np.vdot(source, target) / np.vdot(source, source).real
    if abs(turn) * np.abs(source).max() < _LEAST_PX:
        raise ValueError("clicks: expected points of a face, but they lie in one place")
    seen = turn * (plane - middle) + wanted_middle
    jacobian = [[turn.real, turn.imag, 0], [turn.imag, -turn.real, 0]]
    return face, np.stack([seen.real, seen.imag], 1), np.tile(jacobian, (68, 1, 1))
