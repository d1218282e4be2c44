"""What caricaturists do on paper: parts magnified and moved, lines that wander."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from renders.canvas import smooth_noise

__all__ = ["random_warp", "warped"]

# Points of a part, the span of its window and the spread of the log of its magnification, as shares of the distance
# between the outer corners of the eyes.
_PARTS = (
    (range(48, 60), 0.55, 0.40),
    (range(29, 36), 0.40, 0.35),
    (range(36, 42), 0.30, 0.30),
    (range(42, 48), 0.30, 0.30),
    (range(6, 11), 0.60, 0.35),
    (range(17, 27), 0.70, 0.25),
)
_MOVED = ((range(48, 60), 0.5), (range(29, 36), 0.4), (range(36, 48), 0.6))
_STEEPEST = 0.62  # px/px of the displacement: above 1 the picture would fold


def random_warp(
    rng: np.random.Generator, landmarks: NDArray[np.float64], size: int, amount: float, parts: bool
) -> NDArray[np.float32]:
    """Displacements (size, size, 2) px from the warped picture to its source.

    A smooth random field of standard deviation `amount` px; with `parts`, parts of the face are magnified too.
    """
    knots = int(rng.integers(3, 6))
    field = np.stack([smooth_noise(rng, size, size, knots) * amount for _ in range(2)], axis=-1)
    if parts:
        x, y = np.meshgrid(np.arange(size, dtype=np.float32), np.arange(size, dtype=np.float32))
        unit = np.linalg.norm(landmarks[36] - landmarks[45]) + 8 * size / 256

        def window(middle, span):
            offset = np.stack([x - middle[0], y - middle[1]], axis=-1).astype(np.float32)
            squared = np.einsum("yxc,yxc->yx", offset, offset)
            return np.exp(squared * np.float32(-0.5 / (span * unit) ** 2))[..., None], offset

        for points, span, spread in _PARTS:
            if rng.random() < 0.55:
                shrink = 1 - np.exp(-np.clip(rng.normal(0.08, spread), -0.6, 0.75))
                weight, offset = window(landmarks[list(points)].mean(0), span)
                field -= weight * offset * (shrink * rng.uniform(0.6, 1.4, 2)).astype(np.float32)
        if rng.random() < 0.5:
            for points, span in _MOVED:
                weight, _ = window(landmarks[list(points)].mean(0), span)
                field += weight * (rng.normal(0, 0.09 * unit, 2) * [0.6, 1]).astype(np.float32)
    steep = max(float(np.abs(np.diff(field, axis=axis)).max()) for axis in (0, 1)) + 1e-6
    return field * np.float32(min(1, _STEEPEST / steep))


def warped(field: NDArray[np.float32], landmarks: NDArray[np.float64], *pictures):
    """The landmarks (68, 2) and the pictures, moved by a field of `random_warp`; uint8 pictures keep their values."""
    size = len(field)
    grid = np.stack(np.meshgrid(np.arange(size), np.arange(size)), axis=-1).astype(np.float32) + field
    out = []
    for picture in pictures:
        how = cv2.INTER_NEAREST if picture.dtype == np.uint8 else cv2.INTER_LINEAR
        out.append(cv2.remap(picture, grid, None, how, borderMode=cv2.BORDER_REPLICATE))
    moved = landmarks.copy()
    for _ in range(10):  # the inverse of the field, by fixed points
        moved = landmarks - cv2.remap(field, moved.astype(np.float32)[:, None], None, cv2.INTER_LINEAR)[:, 0]
    return moved, *out
