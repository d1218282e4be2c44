"""Marks of a brush that follows the edges."""

import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.edge_flow import mean_along, streamlines
from toongeo.pipeline.stylize.appearance.pixels import blurred, enlarged
from toongeo.pipeline.stylize.appearance.subject import Subject

__all__ = ["brush_marks"]

# Face sizes: breadth and length of a mark, and the Gaussian of the structure tensor that gives its direction.
_BREADTH, _LENGTH, _TENSOR = 0.010, 0.07, 0.05
_DIAGONAL = (0.02, 0.012, 0.008)  # added to the tensor: where nothing has an edge, strokes are diagonal
_ON_FACE = 0.35  # of their strength elsewhere
_CONTRAST = np.float32(0.030)  # of lightness for one standard deviation
_SEED = 3
_SAMPLES = 8  # to either side along a mark


def brush_marks(subject: Subject, strength: float) -> Singles:
    """Factor (h, w, 1) of the colours: noise averaged along a smooth flow (line integral convolution)."""
    size = subject.size * subject.factor
    noise = np.random.default_rng(_SEED).standard_normal(subject.small.shape[:2]).astype(np.float32)
    lines = streamlines(_smooth_flow(subject, size), _LENGTH * size, samples=_SAMPLES)
    noise = mean_along(blurred(noise, _BREADTH * size), lines)
    noise /= np.maximum(noise.std(), np.float32(1e-6))
    noise *= 1 - (1 - _ON_FACE) * subject.skin.hull
    marks = blurred(enlarged(noise, subject.shape), 0.004 * subject.size)
    return np.asarray((1 + np.float32(strength) * _CONTRAST * marks)[..., None])


def _smooth_flow(subject: Subject, size: float) -> Singles:
    along = subject.flow.astype(np.float32)
    # the tensor of a field of unit tangents, smoothed, has the mean direction as its greatest eigenvector
    x, y = along[..., 0], along[..., 1]
    tensor = [
        blurred(plane, _TENSOR * size) + np.float32(more)
        for plane, more in zip((x * x, x * y, y * y), _DIAGONAL, strict=True)
    ]
    angle = 0.5 * np.arctan2(2 * tensor[1], tensor[0] - tensor[2])
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1).astype(np.float32)
