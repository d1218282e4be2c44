"""The picture resampled onto the plane in which the fit is solved."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.colour.srgb import srgb_to_linear
from toongeo.pipeline.fit.frame.canonical_frame import CanonicalFrame
from toongeo.render.sample_image import sample_image

__all__ = ["RectifiedPicture", "rectified_picture"]

_MARGIN = 12.0  # mm around the projected face: so far the fit may move
_FINE = 2  # picture pixels that an INTER_AREA reduction leaves to a pixel of the plane


@dataclass(frozen=True, eq=False)
class RectifiedPicture:
    """Linear light of the picture on a grid of the canonical frame: the face upright, always of the same size.

    Attributes
    ----------
    light : (h, w, 3) float32
        Linear light, smoothed.
    confidence : (h, w) float32
        In [0, 1]; 0 outside the picture. Row 0 is the top.
    step : float, mm
    left, top : float, mm
        Centre of the pixel (0, 0).
    """

    light: NDArray[np.float32]
    confidence: NDArray[np.float32]
    step: float
    left: float
    top: float

    def grid(self, points: Floats) -> Floats:
        """Canonical points (k, 2) mm, y up -> pixels of the plane (x right, y down)."""
        return (points - [self.left, self.top]) * [1.0, -1.0] / self.step

    def sample(self, points: Floats) -> tuple[Floats, Floats]:
        """Linear light (k, 3) at canonical points (k, 2) mm, and its derivative (k, 3, 2) per mm.

        Bilinear; the derivative is that of the interpolant, so that value and slope belong together. Beyond the
        border the light is constant.
        """
        height, width = self.confidence.shape
        given = self.grid(points)
        px = np.clip(given, 0.0, [width - 1.0, height - 1.0])
        corner = np.minimum(px.astype(np.intp), [width - 2, height - 2])
        fx, fy = (px - corner).T[:, :, None]
        texels = self.light.reshape(-1, 3)
        at = corner[:, 1] * width + corner[:, 0]
        a, b, c, d = (texels.take(at + offset, axis=0).astype(np.float64) for offset in (0, 1, width, width + 1))
        upper, lower = a + (b - a) * fx, c + (d - c) * fx
        slope = np.stack([(b - a) * (1 - fy) + (d - c) * fy, upper - lower], axis=2) / self.step
        inside = (px == given)[:, None, :]
        return upper * (1 - fy) + lower * fy, slope * inside

    def confidence_at(self, points: Floats) -> Floats:
        """Confidence (k,) at canonical points (k, 2) mm; 0 beyond the border."""
        height, width = self.confidence.shape
        px = self.grid(points)
        inside = ((px >= 0) & (px <= [width - 1, height - 1])).all(axis=1)
        return sample_image(self.confidence, px).astype(np.float64) * inside


def rectified_picture(
    img: NDArray[np.uint8],
    mask: NDArray[np.floating] | None,
    frame: CanonicalFrame,
    face: Floats,
    *,
    step: float,
    blur: float,
) -> RectifiedPicture:
    """The part of a picture around the projected face.

    The grid is centred on the origin of the frame, so that a mirrored picture gives the mirrored grid.

    Parameters
    ----------
    img : (H, W, 3) uint8
    mask : (H, W) float in [0, 1] or None
        The caller's confidence; None is 1 everywhere.
    frame : CanonicalFrame
    face : (k, 2) float, mm
        Where the face is, in the frame.
    step, blur : float, mm
    """
    half = np.ceil((np.abs(face[:, 0]).max() + _MARGIN) / step)
    top, bottom = (np.ceil((np.abs(end) + _MARGIN) / step) for end in (face[:, 1].max(), face[:, 1].min()))
    columns = np.arange(-half, half + 1) * step
    rows = np.arange(top, -bottom - 1, -1) * step
    grid = np.stack(np.meshgrid(columns, rows), axis=2).reshape(-1, 2)
    px = grid @ frame.roll[:2, :2].T * [1.0, -1.0] * frame.scale + frame.origin
    shape = (len(rows), len(columns))
    inside = ((px >= -0.5) & (px <= np.array(img.shape[1::-1]) - 0.5)).all(axis=1).astype(np.float32)
    light = _resampled(img, px, frame.scale * step, frame.scale * blur, linear=True)
    if mask is not None:
        inside *= _resampled(mask[:, :, None], px, frame.scale * step, frame.scale * step, linear=False)[:, 0]
    return RectifiedPicture(light.reshape(*shape, 3), inside.reshape(shape), step, float(columns[0]), float(rows[0]))


def _resampled(img: NDArray, px: Floats, step: float, blur: float, *, linear: bool) -> NDArray[np.float32]:
    """Smoothed values (k, c) of a picture at pixels (k, 2) that lie ``step`` px apart."""
    height, width = img.shape[:2]
    reach = int(np.ceil(3 * blur)) + 2
    x0, y0 = np.clip(np.floor(px.min(axis=0)).astype(int) - reach, 0, [width - 1, height - 1])
    x1, y1 = np.clip(np.ceil(px.max(axis=0)).astype(int) + reach, [x0 + 1, y0 + 1], [width, height])
    part = np.ascontiguousarray(img[y0:y1, x0:x1])
    values: NDArray = np.asarray(srgb_to_linear(part) if linear else part, dtype=np.float32)
    factor = np.array([1.0, 1.0])
    if step >= 2 * _FINE:
        size = np.maximum(np.array(values.shape[1::-1]) * _FINE // int(step), 1)
        factor = size / np.array(values.shape[1::-1])
        values = cv2.resize(values, (int(size[0]), int(size[1])), interpolation=cv2.INTER_AREA)
    sigma = blur * factor
    if sigma.max() > 0.3:  # a narrower Gaussian does not reach the next pixel
        values = cv2.GaussianBlur(values, (0, 0), sigma[0], sigmaY=sigma[1], borderType=cv2.BORDER_REPLICATE)
    values = values.reshape(values.shape[0], values.shape[1], -1)
    return sample_image(values, (px - [x0, y0] + 0.5) * factor - 0.5).astype(np.float32)
