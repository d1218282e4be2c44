"""The flow along the edges of a picture, and filters that follow it."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.pixels import blurred, sampled

__all__ = ["Streamlines", "abstracted", "line_response", "mean_along", "streamlines", "tangent_flow"]

# Sigmas in face sizes: of the structure tensor, of the mean across edges and of that along them.
_TENSOR, _ACROSS, _ALONG = 0.014, 0.010, 0.022
_SAMPLES_ACROSS, _SAMPLES_ALONG = 2, 3  # to either side; more change nothing that is seen
_REACH, _REACH_ACROSS = 2.2, 2.0  # sigmas to the last sample along the flow, and across it
_FRESH = 2  # passes after which the flow is that of the smoothed picture for good
# Of lines: the narrower Gaussian, and how much wider the other one is. The mean along the flow is that of the
# abstraction (Kyprianidis and Kang).
_LINE, _WIDER = 0.0065, 1.6


@dataclass(frozen=True, eq=False)
class Streamlines:
    """Where the streamlines through each pixel lead: `places`, each (h, w, 2) px, and `shares` of a Gaussian there."""

    places: tuple[Singles, ...]
    shares: tuple[float, ...]


def tangent_flow(picture: Singles, sigma: float) -> Singles:
    """Unit tangents (h, w, 2) along the edges: least eigenvectors of the smoothed structure tensor (Kang et al. 2007).

    Parameters
    ----------
    picture : (h, w) or (h, w, c) float32
    sigma : float, px
        Of the tensor's Gaussian.
    """
    across, down = (np.asarray(cv2.Scharr(picture, cv2.CV_32F, *axis), np.float32) for axis in ((1, 0), (0, 1)))
    xx, xy, yy = (blurred(_dot(*pair), sigma) for pair in ((across, across), (across, down), (down, down)))
    angle = np.arctan2(2 * xy, xx - yy) / 2 + np.float32(np.pi / 2)
    return np.asarray(cv2.merge(list(cv2.polarToCart(np.ones_like(angle), angle))))


def streamlines(flow: Singles, sigma: float, samples: int = _SAMPLES_ALONG) -> Streamlines:
    """Follow a flow (h, w, 2) without direction both ways; sigma of the Gaussian along it in px."""
    step = _REACH * sigma / samples
    start = _grid(flow.shape[:2])
    places, shares = [], []
    for sign in (1, -1):
        at, direction = start, np.float32(sign) * flow
        for k in range(1, samples + 1):
            at = np.asarray(cv2.scaleAdd(direction, step, at))
            places.append(at)
            shares.append(float(np.exp(-0.5 * (k * step / sigma) ** 2)))
            if k < samples:
                ahead = sampled(flow, at, cv2.INTER_NEAREST, cv2.BORDER_REFLECT_101)
                same = np.copysign(np.float32(1), _dot(ahead, direction))
                direction = np.asarray(cv2.multiply(ahead, cv2.merge([same, same])))
    return Streamlines(tuple(places), tuple(shares))


def mean_along(picture: Singles, lines: Streamlines) -> Singles:
    """Gaussian mean of a picture (h, w[, c]) along streamlines."""
    total = picture.copy()
    for at, share in zip(lines.places, lines.shares, strict=True):
        cv2.scaleAdd(sampled(picture, at, cv2.INTER_LINEAR, cv2.BORDER_REFLECT_101), share, total, total)
    total *= np.float32(1 / (1 + sum(lines.shares)))
    return total


def abstracted(lab: Singles, size: float, passes: int, tolerance: float) -> tuple[Singles, Singles, Streamlines]:
    """A picture smoothed within its edges, its flow, and its streamlines: bilateral across the flow, mean along it,
    several times.

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
    for k in range(passes):
        if k < _FRESH:
            flow = tangent_flow(lab, _TENSOR * size)
            lines = streamlines(flow, _ALONG * size)
        lab = mean_along(_bilateral_across(lab, flow, _ACROSS * size, tolerance), lines)
    return lab, flow, lines


def line_response(lightness: Singles, lines: Streamlines, size: float) -> Singles:
    """Difference of Gaussians, averaged along streamlines; positive on dark lines (FDoG, Kang et al. 2007)."""
    narrow = blurred(lightness, _LINE * size)
    wide = blurred(lightness, _WIDER * _LINE * size)
    return mean_along(wide - narrow, lines)


def _bilateral_across(picture: Singles, flow: Singles, sigma: float, tolerance: float) -> Singles:
    """Mean over a line across the flow, of colours alike."""
    normal = np.stack([-flow[..., 1], flow[..., 0]], axis=-1)
    start = _grid(flow.shape[:2])
    total, weight = np.zeros_like(picture), np.ones(picture.shape[:2], np.float32)
    for k in (*range(-_SAMPLES_ACROSS, 0), *range(1, _SAMPLES_ACROSS + 1)):
        distance = _REACH_ACROSS * k / _SAMPLES_ACROSS
        at = np.asarray(cv2.scaleAdd(normal, distance * sigma, start), np.float32)
        other = sampled(picture, at, cv2.INTER_LINEAR, cv2.BORDER_REFLECT_101)
        difference = np.asarray(cv2.subtract(other, picture), np.float32)
        unlike = _dot(difference, difference)
        unlike *= np.float32(-0.5 / tolerance**2)
        unlike += np.float32(-0.5 * distance**2)
        share = np.exp(unlike, out=unlike)
        total += cv2.multiply(difference, cv2.merge([share, share, share]))
        weight += share
    total *= cv2.merge([1 / weight] * 3)
    total += picture
    return np.asarray(total, np.float32)


def _dot(a: Singles, b: Singles) -> Singles:
    """Inner products (h, w) over the last of three axes; products of planes."""
    product = np.asarray(cv2.multiply(a, b), np.float32)
    if product.ndim == 2:
        return product
    return np.asarray(cv2.transform(product, np.ones((1, product.shape[2]), np.float32)), np.float32)


def _grid(shape: tuple[int, ...]) -> Singles:
    rows, columns = np.mgrid[: shape[0], : shape[1]].astype(np.float32)
    return np.asarray(cv2.merge([columns, rows]), np.float32)
