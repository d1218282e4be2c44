"""Soft edges of hair."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Singles
from toongeo.pipeline.parse.masks import Mask, grown

__all__ = ["hair_alpha"]


_BAND = 0.025  # head sizes on either side of the outline that may be mixed
_RADIUS = 0.03  # head sizes: window of the filter
_SOFTNESS = 1e-3  # squared colour differences that count as noise


def hair_alpha(pixels: NDArray[np.uint8], mask: Mask, head: float) -> Singles:
    """How far hair covers each pixel (h, w), in [0, 1]: the mask by a guided filter (He et al. 2013) along its outline.

    Parameters
    ----------
    pixels : (h, w, 3) uint8
    mask : (h, w) bool
    head : float
        Size of the head, px.
    """
    band = grown(mask, _BAND * head) & ~grown(mask, -_BAND * head)
    soft = _guided(pixels.astype(np.float64) / 255, mask.astype(np.float64), band, max(2, round(_RADIUS * head)))
    return np.where(band, np.clip(soft, 0, 1), mask).astype(np.float32)


def _guided(guide: NDArray[np.float64], mask: NDArray[np.float64], band: Mask, radius: int) -> NDArray[np.float64]:
    """The mask as a linear function of the colours in each window, averaged over the windows of a pixel of the band.

    OpenCV's own filter gives up where the channels are dependent, that is, on grey pictures.
    """
    size = 2 * radius + 1
    box = lambda field: cv2.blur(field, (size, size))  # noqa: E731
    windows = grown(band, 1.5 * radius)
    mean, level = box(guide), box(mask)
    together = box(guide * mask[..., None]) - mean * level[..., None]
    spread = np.stack([box(guide * guide[..., c : c + 1]) - mean * mean[..., c : c + 1] for c in range(3)], axis=-1)
    slope = np.zeros_like(guide)
    inside = spread[windows] + _SOFTNESS * np.eye(3)
    slope[windows] = np.linalg.solve(inside, together[windows][..., None])[..., 0]
    offset = level - (slope * mean).sum(axis=2)
    return np.asarray((box(slope) * guide).sum(axis=2) + box(offset))
