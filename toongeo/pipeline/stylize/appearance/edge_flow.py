"""The flow along the edges of a picture, and filters that follow it."""

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.pixels import blurred, sampled

__all__ = ["abstracted", "line_response", "mean_along", "tangent_flow"]

# Sigmas in face sizes: of the structure tensor, of the mean across edges and of that along them.
_TENSOR, _ACROSS, _ALONG = 0.012, 0.010, 0.022
_FINAL_TENSOR = 0.014  # of the flow that lines follow
_SAMPLES_ACROSS, _SAMPLES_ALONG = 3, 4  # to either side
_REACH = 2.2  # sigmas to the last sample along the flow
# Of lines: the narrower Gaussian, how much wider the other one is, and the mean along the flow (Kyprianidis and Kang).
_LINE, _WIDER, _LINE_ALONG = 0.0065, 1.6, 0.02


def tangent_flow(picture: Singles, sigma: float) -> Singles:
    """Unit tangents (h, w, 2) along the edges: least eigenvectors of the smoothed structure tensor (Kang et al. 2007).

    Parameters
    ----------
    picture : (h, w) or (h, w, c) float32
    sigma : float, px
        Of the tensor's Gaussian.
    """
    across, down = (np.asarray(cv2.Scharr(picture, cv2.CV_32F, *axis), np.float32) for axis in ((1, 0), (0, 1)))
    if picture.ndim == 2:
        across, down = across[..., None], down[..., None]
    tensor = np.stack([_dot(across, across), _dot(across, down), _dot(down, down)], axis=-1)
    xx, xy, yy = np.moveaxis(blurred(np.asarray(tensor, np.float32), sigma), -1, 0)
    angle = np.arctan2(2 * xy, xx - yy) / 2 + np.pi / 2
    return np.asarray(np.stack([np.cos(angle), np.sin(angle)], axis=-1), np.float32)


def mean_along(picture: Singles, flow: Singles, sigma: float, samples: int = _SAMPLES_ALONG) -> Singles:
    """Gaussian mean along the streamlines of a flow without direction; sigma in px."""
    step = np.float32(_REACH * sigma / samples)
    start = _grid(flow.shape[:2])
    total, weight = picture.copy(), 1.0
    for sign in (1, -1):
        at, direction = start.copy(), sign * flow
        for k in range(1, samples + 1):
            at = at + step * direction
            share = float(np.exp(-0.5 * (k * step / sigma) ** 2))
            total = total + np.float32(share) * sampled(picture, at, cv2.INTER_LINEAR, cv2.BORDER_REFLECT_101)
            weight += share
            if k < samples:
                ahead = sampled(flow, at, cv2.INTER_NEAREST, cv2.BORDER_REFLECT_101)
                backwards = _dot(ahead, direction)[..., None] < 0
                direction = np.where(backwards, -ahead, ahead)
    return np.asarray(total / np.float32(weight))


def abstracted(lab: Singles, size: float, passes: int, tolerance: float) -> tuple[Singles, Singles]:
    """A picture smoothed within its edges, and its flow: bilateral across the flow, mean along it, several times.

    Parameters
    ----------
    lab : (h, w, 3) float32
        CIELAB.
    size : float, px
        Of the face.
    passes : int
    tolerance : float
        Colour difference (Lab) that still counts as the same.

    References
    ----------
    J. E. Kyprianidis, J. Doellner: Image abstraction by structure adaptive filtering. TPCG 2008.
    """
    for _ in range(passes):
        flow = tangent_flow(lab, _TENSOR * size)
        lab = mean_along(_bilateral_across(lab, flow, _ACROSS * size, tolerance), flow, _ALONG * size)
    return lab, tangent_flow(lab, _FINAL_TENSOR * size)


def line_response(lightness: Singles, flow: Singles, size: float) -> Singles:
    """Difference of Gaussians, averaged along the flow; positive on dark lines (FDoG, Kang et al. 2007)."""
    narrow = blurred(lightness, _LINE * size)
    wide = blurred(lightness, _WIDER * _LINE * size)
    return mean_along(wide - narrow, flow, _LINE_ALONG * size)


def _bilateral_across(picture: Singles, flow: Singles, sigma: float, tolerance: float) -> Singles:
    """Mean over a line across the flow, of colours alike."""
    normal = np.stack([-flow[..., 1], flow[..., 0]], axis=-1)
    start = _grid(flow.shape[:2])
    total, weight = picture.copy(), np.ones((*picture.shape[:2], 1), np.float32)
    for k in range(-_SAMPLES_ACROSS, _SAMPLES_ACROSS + 1):
        if k == 0:
            continue
        distance = 2 * sigma * k / _SAMPLES_ACROSS
        other = sampled(picture, start + np.float32(distance) * normal, cv2.INTER_LINEAR, cv2.BORDER_REFLECT_101)
        difference = other - picture
        unlike = _dot(difference, difference)[..., None]
        share = np.exp(np.float32(-0.5 * (distance / sigma) ** 2) - unlike / np.float32(2 * tolerance**2))
        total += share * other
        weight += share
    return np.asarray(total / weight)


def _dot(a: Singles, b: Singles) -> Singles:
    """Inner products (h, w) over the last axis."""
    return np.asarray(np.einsum("...i,...i", a, b))


def _grid(shape: tuple[int, ...]) -> Singles:
    rows, columns = np.mgrid[: shape[0], : shape[1]].astype(np.float32)
    return np.stack([columns, rows], axis=-1)
