"""How far each pixel of the face is to be believed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.picture_plane import PicturePlane

__all__ = ["skin_likelihood"]

Floats = NDArray[np.float64]

_FLOOR = 0.02  # linear light below which colours are noise
_SPREADS = np.array([0.6, 0.03, 0.03])  # least spread of skin: log of the luminance, and chromaticity
_REACH = 2.5  # spreads at which a pixel counts half
_VOTERS = 400  # points among which the commonest colour is looked for


def skin_likelihood(plane: PicturePlane, core: Floats) -> NDArray[np.float32]:
    """Likelihood (h, w) in [0, 1] that a pixel shows the same skin as the middle of the face.

    Colour and brightness of the skin are learned from the picture itself, so that drawings with green skin, grey
    photographs and all complexions are alike: the commonest colour of the points in ``core``, and the deviation of
    those around it. Hair, beards, glasses, eyes and highlights fall outside.

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
    near = features[_around_mode(features / _SPREADS)]
    centre = np.median(near, axis=0)
    spread = np.maximum(1.4826 * np.median(np.abs(near - centre), axis=0), _SPREADS)
    distance2 = (((_features(plane.light) - centre) / (_REACH * spread)) ** 2).sum(axis=-1)
    return (1 / (1 + distance2**4)).astype(np.float32)


def _around_mode(features: Floats) -> NDArray[np.bool_]:
    """Which points (k,) lie around the densest place: where a Gaussian of unit spread catches most of them."""
    # Every so many of them by brightness, not by vertex: a mirrored picture has the same voters.
    voters = features[np.argsort(features[:, 0])][:: max(1, len(features) // _VOTERS)]
    distance2 = ((voters[:, None] - voters) ** 2).sum(axis=2)
    mode = voters[np.exp(-distance2 / 2).sum(axis=1).argmax()]
    return ((features - mode) ** 2).sum(axis=1) < _REACH**2


def _features(light: NDArray[np.floating]) -> NDArray[np.floating]:
    """Log luminance and two chromaticities (..., 3), the last nearly free of shading."""
    total = light.sum(axis=-1, keepdims=True) + 3 * _FLOOR
    chromaticity = (light[..., :2] + _FLOOR) / total
    return np.concatenate([np.log(total), chromaticity], axis=-1)
