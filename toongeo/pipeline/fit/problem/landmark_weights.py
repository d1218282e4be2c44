"""How much each landmark counts, and in which direction.

Constants were chosen on heads of known shape and ten pictures (``benchmarks/truth3d.py``, ``benchmarks/landmarks.py``).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry import vertex_normals
from toongeo.model.anatomy.visible_landmarks import jaw_weights
from toongeo.model.ibug68 import INNER, PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.fit_options import FitOptions

__all__ = ["evened_weights", "landmark_weights"]

_CLICK_MM = 1.0  # standard deviation of a click, on the head
_GUESSED = 0.1  # weight of a jaw point whose whole line is out of sight: the face hides it


def landmark_weights(points: Floats, model: MorphableModel, rotation: Floats, options: FitOptions) -> Floats:
    """Weights (68, 2, 2) of Eq. 4: the precision of each point as a pose shows it, relative to an inner point.

    The covariance of a point in the picture is that of its place on the head, projected, and that of a click. Jaw
    points weigh as the options say, and a tenth of that where their contour line is turned away from the viewer.

    Parameters
    ----------
    points : (68, 2) float
        In any frame similar to the picture, y up; NaN rows are missing.
    model : MorphableModel
    rotation : (3, 3) float
        From the model to the frame of the points.
    options : FitOptions
    """
    weights = np.tile(np.eye(2), (68, 1, 1))
    if model.prior is not None:
        spread = rotation[:2] @ model.prior.landmark_covariance @ rotation[:2].T + _CLICK_MM**2 * np.eye(2)
        precision = np.linalg.inv(spread)
        weights = precision / (np.trace(precision[INNER], axis1=1, axis2=2).mean() / 2)
    seen = np.where(_front_normals(model) @ rotation[2] > 0, 1.0, _GUESSED)[:, None, None]
    weights[PARTS["jaw"]] = options.jaw.weight * seen * jaw_weights(points[PARTS["jaw"]], options.jaw.tangent)
    return weights


def evened_weights(weights: Floats, shared: float, unit: float) -> Floats:
    """Weights (k, 2, 2) when a misfit that all points share makes their own noise count less.

    With the covariance ``W^-1`` of a point and the shared variance s these are ``(W^-1 + s I)^-1``, in units of
    ``1 / (1 + s)``.

    Parameters
    ----------
    weights : (k, 2, 2) float, 1/unit^2
    shared : float >= 0
        s.
    unit : float
    """
    if shared == 0:
        return weights
    W = weights * unit**2
    trace, determinant = W[:, 0, 0] + W[:, 1, 1], W[:, 0, 0] * W[:, 1, 1] - W[:, 0, 1] * W[:, 1, 0]
    # W (I + s W)^-1 = (W + s det W I) / det(I + s W): in two dimensions the adjugate of W times W is det W.
    even = W + (shared * determinant)[:, None, None] * np.eye(2)
    return (1 + shared) / unit**2 * even / (1 + shared * trace + shared**2 * determinant)[:, None, None]


@lru_cache(maxsize=4)
def _front_normals(model: MorphableModel) -> Floats:
    """Normals (17, 3) of the mean face where the contour lines begin."""
    return vertex_normals(model.mean, model.faces)[[line[0] for line in model.contour_lines]]
