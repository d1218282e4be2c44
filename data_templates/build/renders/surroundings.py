"""What is behind and around a head: walls, clutter, photographs in the public domain, hair behind the neck, clothes."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import cv2
import numpy as np
import skimage.data
from numpy.typing import NDArray

from renders.canvas import Canvas, between, fractal_noise
from renders.palette import random_colour

__all__ = ["FACELESS", "background", "faceless_pictures", "paint_back_hair", "paint_clothes"]

# Pictures without a face that come with scikit-image's wheel, in the public domain or CC0 (see its README.txt).
FACELESS = ("coffee.png", "rocket.jpg", "brick.png", "grass.png", "gravel.png", "hubble_deep_field.jpg", "moon.png")


@cache
def faceless_pictures() -> tuple[NDArray[np.uint8], ...]:
    """Those pictures, (h, w, 3) RGB."""
    folder = Path(skimage.data.__file__).parent
    return tuple(cv2.cvtColor(cv2.imread(str(folder / name)), cv2.COLOR_BGR2RGB) for name in FACELESS)


def background(rng: np.random.Generator, size: int) -> NDArray[np.float32]:
    """(size, size, 3) float32, 0-255."""
    if rng.random() < 0.12:
        return _photograph(rng, size)
    picture = np.empty((size, size, 3), np.float32)
    picture[:] = random_colour(rng) if rng.random() < 0.7 else rng.choice([255.0, 245.0, 20.0])
    mood = rng.random()
    if mood < 0.55:
        picture += (fractal_noise(rng, size, size) * between(rng, 5, 45))[..., None] * rng.uniform(0.6, 1.2, 3)
    if mood > 0.4:
        _paint_clutter(rng, Canvas(picture), size)
    if rng.random() < 0.4:
        picture = cv2.GaussianBlur(picture, (0, 0), between(rng, 1, 8) * size / 256)
    return picture


def _photograph(rng: np.random.Generator, size: int) -> NDArray[np.float32]:
    picture = faceless_pictures()[rng.integers(len(FACELESS))]
    side = int(min(picture.shape[:2]) * between(rng, 0.3, 1))
    y, x = (int(rng.integers(0, length - side + 1)) for length in picture.shape[:2])
    cut = np.rot90(picture[y : y + side, x : x + side], rng.integers(4))
    return cv2.resize(np.ascontiguousarray(cut), (size, size), interpolation=cv2.INTER_AREA).astype(np.float32)


def _paint_clutter(rng, canvas: Canvas, size: int) -> None:
    for _ in range(rng.integers(0, 14)):
        colour, kind = random_colour(rng), rng.integers(4)
        if kind == 0:
            canvas.ellipse(rng.uniform(0, size, 2), rng.uniform(0.02, 0.35, 2) * size, colour)
        elif kind == 1:
            corners = cv2.convexHull(rng.uniform(0, size, (4, 2)).astype(np.float32))[:, 0]
            canvas.fill(corners, colour)
        elif kind == 2:
            canvas.stroke(rng.uniform(0, size, (2, 2)), colour, 1, size * between(rng, 0.004, 0.035))
        else:  # a row of letters
            mask, text = np.zeros((size, size), np.uint8), "".join(chr(c) for c in rng.integers(65, 91, 8))
            place = tuple(int(v) for v in rng.integers(0, size, 2))
            cv2.putText(mask, text, place, int(rng.integers(8)), between(rng, 0.4, 2), 255, 2, 16)
            canvas.picture[mask > 127] = colour


def paint_back_hair(rng, canvas: Canvas, flat: NDArray, scalp: NDArray[np.bool_], colour, label: int) -> None:
    """Long hair behind the neck of the head whose vertices lie at `flat` (n, 2) px."""
    top, size = flat[scalp].mean(0), len(canvas.picture)
    half, low = np.ptp(flat[:, 0]) * between(rng, 0.5, 0.75), flat[:, 1].max() * between(rng, 0.7, 1.05)
    left, right = (between(rng, 0.7, 1.3) * half for _ in range(2))
    middle = half * between(rng, 0.9, 1.2)
    half_way = (top[1] + low) / 2
    x, y = top
    ring = [
        (x - 0.8 * half, y),
        (x - middle, half_way),
        (x - left, low),
        (x + right, low),
        (x + middle, half_way),
        (x + 0.8 * half, y),
    ]
    canvas.fill(
        _rounded(np.array(ring)), colour * between(rng, 0.4, 1), blur=size * between(rng, 0, 0.006), label=label
    )


def _rounded(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """The ring with its corners cut twice (Chaikin)."""
    for _ in range(2):
        after = np.roll(ring, -1, axis=0)
        ring = np.stack([0.75 * ring + 0.25 * after, 0.25 * ring + 0.75 * after], 1).reshape(-1, 2)
    return ring


def paint_clothes(rng, canvas: Canvas, neck: NDArray[np.float64], label: int) -> None:
    """Shoulders, and a collar, over the neck whose vertices lie at (k, 2) px."""
    size = len(canvas.picture)
    unit = size / 256
    y, x, half = np.percentile(neck[:, 1], between(rng, 55, 90)), neck[:, 0].mean(), np.ptp(neck[:, 0]) * 0.55
    colour, slope, dip = random_colour(rng), between(rng, 15, 60) * unit, between(rng, 0, 40) * unit
    ring = [(x - half, y), (x, y + dip), (x + half, y), (x + 3.2 * half, y + slope)]
    ring += [(x + 4 * half, size + 60), (x - 4 * half, size + 60), (x - 3.2 * half, y + slope)]
    canvas.fill(ring, colour, label=label)
    collar = np.array(ring[:3])
    canvas.stroke(collar, colour * between(rng, 0.3, 1.5), 1, rng.integers(1, 6) * unit)
    kind = rng.random()
    if kind < 0.2:  # a jacket over a shirt, with a tie
        lapel = np.array([(x, y + dip), (x - half * 1.3, y), (x - half, size + 9), (x, size + 9)])
        mirrored = lapel * [-1, 1] + [2 * x, 0]
        shirt = np.array([(x - half, y), (x + half, y), (x, y + dip + 60 * unit)])
        canvas.fill(shirt, rng.uniform(180, 255) * np.ones(3), label=label)
        for side in (lapel, mirrored):
            canvas.stroke(side[:2], colour * 0.4, 1, 2 * unit)
        tie = np.array([(x - 4, y + dip), (x + 4, y + dip), (x + 7, size + 9), (x - 7, size + 9)])
        canvas.fill(tie, random_colour(rng), label=label)
    elif kind < 0.4:  # stripes
        for k in range(int(rng.integers(2, 7))):
            at = y + slope + 14 * k * unit
            canvas.stroke([(x - 3 * half, at), (x + 3 * half, at)], random_colour(rng), 0.7, 3 * unit)
