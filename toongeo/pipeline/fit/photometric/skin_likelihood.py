"""How far each pixel of the face is to be believed.

Constants were chosen on rendered faces, seeds 20-29, and looked at on ten pictures (``benchmarks/photometric.py``).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.pipeline.fit.photometric.rectified_picture import RectifiedPicture

__all__ = ["skin_likelihood"]

_FLOOR = 0.02  # linear light below which colours are noise
_SPREADS = np.array([0.6, 0.03, 0.03])  # least spread of skin: log of the luminance, and chromaticity
_REACH = 2.5  # spreads at which a pixel counts half
_CONCENTRATIONS = 10  # steps at most towards the densest part, as in the fast minimum covariance determinant
_COMMON = 0.6  # of the points, at least, are taken to be skin
_OF_COMMON = 2.05  # covariance of a normal variable in 3-D over that of this part around its mean


def skin_likelihood(plane: RectifiedPicture, core: Floats) -> NDArray[np.float32]:
    """Likelihood (h, w) in [0, 1] that a pixel shows the same skin as the middle of the face.

    Colour and brightness of the skin are learned from the picture itself, so that drawings with green skin, grey
    photographs and all complexions are alike: mean and covariance of the greater part of the points in ``core``.
    What light and shadow change together counts as one. Hair, beards, glasses, eyes and highlights fall outside.

    Parameters
    ----------
    plane : RectifiedPicture
    core : (k, 2) float, mm
        Canonical points on cheeks and nose that are seen.
    """
    known = core[plane.confidence_at(core) > 0.5]
    if not len(known):
        return np.ones(plane.confidence.shape, np.float32)
    centre, covariance = _common(_features(plane.sample(known)[0]))
    away = _features(plane.light) - centre
    distance2 = (away @ np.linalg.inv(covariance) * away).sum(axis=-1) / _REACH**2
    return (1 / (1 + distance2**4)).astype(np.float32)


def _common(features: NDArray[np.floating]) -> tuple[Floats, Floats]:
    """Mean (3,) and covariance (3, 3) of those of the points (k, 3) that are most alike (P. Rousseeuw, K. Van
    Driessen, "A fast algorithm for the minimum covariance determinant estimator", Technometrics 1999), as of a normal
    distribution.
    """
    centre = np.median(features, axis=0)
    covariance = np.diag((1.4826 * np.median(np.abs(features - centre), axis=0)) ** 2 + _SPREADS**2)
    for _ in range(_CONCENTRATIONS):
        away = features - centre
        distance2 = (away @ np.linalg.inv(covariance) * away).sum(axis=1)
        common = features[distance2 <= np.quantile(distance2, _COMMON)]
        centre = common.mean(axis=0)
        away = common - centre
        covariance = _OF_COMMON * (away.T @ away) / len(common) + np.diag(_SPREADS**2)
    return centre, covariance


def _features(light: NDArray[np.floating]) -> NDArray[np.floating]:
    """Log luminance and two chromaticities (..., 3), the last nearly free of shading."""
    total = light.sum(axis=-1, keepdims=True) + 3 * _FLOOR
    chromaticity = (light[..., :2] + _FLOOR) / total
    return np.concatenate([np.log(total), chromaticity], axis=-1)
