"""Pictures without a face: photographs in the public domain, and procedural ones."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import skimage.data
from numpy.typing import NDArray
from renders.surroundings import background

__all__ = ["CALIBRATION", "CLUTTER", "clutter_pictures"]

# Of scikit-image's wheel, in the public domain or CC0; chelsea.png, horse.png and others are kept for tests. The first
# are trained on, the others calibrate.
CLUTTER = (
    "coffee.png",
    "rocket.jpg",
    "brick.png",
    "grass.png",
    "gravel.png",
    "hubble_deep_field.jpg",
    "moon.png",
    "text.png",
    "clock_motion.png",
)
CALIBRATION = ("retina.jpg", "cell.png", "microaneurysms.png")
_LONGEST_PX = 480


def clutter_pictures(rng: np.random.Generator, names: tuple[str, ...], procedural: int) -> list[NDArray[np.uint8]]:
    """Grey pictures (h, w): each photograph in four turns and at a second size, and so many procedural ones."""
    folder = Path(skimage.data.__file__).parent
    pictures = []
    for name in names:
        grey = cv2.imread(str(folder / name), cv2.IMREAD_GRAYSCALE)
        scale = _LONGEST_PX / max(grey.shape)
        grey = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        half = grey[: grey.shape[0] * 2 // 3, : grey.shape[1] * 2 // 3]
        for turns in range(4):
            pictures += [np.ascontiguousarray(np.rot90(part, turns)) for part in (grey, half)]
    for _ in range(procedural):
        pictures.append(cv2.cvtColor(np.clip(background(rng, 256), 0, 255).astype(np.uint8), cv2.COLOR_RGB2GRAY))
    return pictures
