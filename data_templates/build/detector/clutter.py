"""Pictures without a face: photographs in the public domain, and procedural ones."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import skimage.data
from numpy.typing import NDArray
from renders.canvas import between
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
_PAGE_PX = 384
_LETTERS = "aaabcdeeeefghiiijklmnnoooprrssttuuvwxyz    .,:;0123456789ABDEGHKMNRST"
_FONTS = (cv2.FONT_HERSHEY_SIMPLEX, cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_COMPLEX, cv2.FONT_HERSHEY_TRIPLEX)


def clutter_pictures(rng: np.random.Generator, names: tuple[str, ...], procedural: int) -> list[NDArray[np.uint8]]:
    """Grey pictures (h, w): each photograph in four turns and at a second size, so many procedural ones and as many
    printed pages."""
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
    return pictures + [_page(rng) for _ in range(procedural)]


def _page(rng: np.random.Generator) -> NDArray[np.uint8]:
    """Writing and a drawing of plain shapes: lines as clean as those of figures, and no face."""
    paper, ink = (between(rng, *shade) for shade in ((190, 255), (0, 90)))
    page = np.full((_PAGE_PX, _PAGE_PX), round(paper), np.uint8)
    for _ in range(rng.integers(0, 5)):
        middle = tuple(int(x) for x in rng.integers(0, _PAGE_PX, 2))
        axes, shade = rng.integers(10, _PAGE_PX // 3, 2), between(rng, 0, 255)
        width = -1 if rng.random() < 0.4 else int(rng.integers(1, 7))
        if rng.random() < 0.6:
            cv2.ellipse(
                page, middle, tuple(int(a) for a in axes), between(rng, 0, 180), 0, 360, shade, width, cv2.LINE_AA
            )
        else:
            cv2.rectangle(page, middle, tuple(int(x) for x in middle + axes), shade, width, cv2.LINE_AA)
    size, y = between(rng, 0.3, 1.6), int(rng.integers(5, 60))
    while y < _PAGE_PX and rng.random() < 0.97:
        words = "".join(rng.choice(list(_LETTERS), 80))
        font = int(rng.choice(_FONTS))
        cv2.putText(page, words, (int(rng.integers(-20, 60)), y), font, size, ink, int(rng.integers(1, 3)), cv2.LINE_AA)
        y += int(between(rng, 25, 45) * size) + 3
    page = cv2.GaussianBlur(page.astype(np.float64), (0, 0), between(rng, 0.3, 1.5)) + rng.normal(
        0, between(rng, 0, 8), page.shape
    )
    return np.clip(page if rng.random() < 0.8 else 255 - page, 0, 255).astype(np.uint8)
