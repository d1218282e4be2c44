"""How far each pixel of the face is to be believed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.picture_plane import PicturePlane

__all__ = ["skin_likelihood"]

Floats = NDArray[np.float64]

_FLOOR = 0.02  # linear light below which colours are noise
_SPREADS = np.array([0.45, 0.035, 0.035])  # least spread of skin: log of the luminance, and chromaticity
_REACH = 3.0  # spreads at which a pixel counts half


def skin_likelihood(plane: PicturePlane, core: Floats) -> NDArray[np.float32]:
    """Likelihood (h, w) in [0, 1] that a pixel shows the same skin as the middle of the face.

    Colour and brightness of the skin are learned from the picture itself, so that drawings with green skin, grey
    photographs and all complexions are alike: the median of the points in ``core`` and their median absolute
    deviation. Hair, beards, glasses, eyes and highlights fall outside.

    Parameters
    ----------
    plane : PicturePlane
    core : (k, 2) float, mm
        Canonical points on cheeks, nose and forehead that are seen.
    """
    known = core[plane.trust(core) > 0.5]
    if not len(known):
        return np.ones(plane.confidence.shape, np.float32)
    features = _features(plane.sample(known)[0])
    centre = np.median(features, axis=0)
    spread = np.maximum(1.4826 * np.median(np.abs(features - centre), axis=0), _SPREADS)
    distance2 = (((_features(plane.light) - centre) / (_REACH * spread)) ** 2).sum(axis=-1)
    return (1 / (1 + distance2**2)).astype(np.float32)


def _features(light: NDArray[np.floating]) -> NDArray[np.floating]:
    """Log luminance and two chromaticities (..., 3), the last nearly free of shading."""
    total = light.sum(axis=-1, keepdims=True) + 3 * _FLOOR
    chromaticity = (light[..., :2] + _FLOOR) / total
    return np.concatenate([np.log(total), chromaticity], axis=-1)
