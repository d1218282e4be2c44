"""How a scene is drawn: photographs, grey prints, ink, flat colours, posters, paint, pencil."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from renders.canvas import Canvas, between, fractal_noise

__all__ = ["STYLES", "developed", "draw_features", "rendered_in_style", "trace_edges"]

STYLES = ("photo", "grey", "flat", "painted", "ink", "posterized", "pencil", "outlined")
_BROWS, _LIDS = ((17, 22), (22, 27)), ((36, 40), (42, 46))
_LOWER_LIDS = ([39, 40, 41, 36], [45, 46, 47, 42])


def trace_edges(rng: np.random.Generator, picture: NDArray[np.float32], edges: NDArray[np.float32]):
    """The picture with its edges drawn dark."""
    unit = len(picture) / 256
    line = cv2.GaussianBlur(edges, (0, 0), between(rng, 0.5, 1.6) * unit)
    line = np.clip(line * between(rng, 1.5, 3), 0, 1)[..., None]
    return picture * (1 - line * between(rng, 0.4, 1))


def draw_features(rng: np.random.Generator, picture: NDArray[np.float32], landmarks: NDArray[np.float64]) -> None:
    """Lines an artist draws over lids, lips, nose, jaw and brows, in place."""
    canvas, unit = Canvas(picture), len(picture) / 256
    width, colour = rng.integers(1, 4), np.ones(3) * between(rng, 0, 60)

    def line(rows, chance: float, extra: float = 0.0, closed: bool = False) -> None:
        if rng.random() < chance:
            points = landmarks[rows] + rng.normal(0, 0.5 * unit, (len(landmarks[rows]), 2))
            canvas.stroke(_smooth(points, closed), colour, 1, (width + extra) * unit, closed=closed)

    for first, last in _LIDS:
        line(slice(first, last), 0.8, rng.integers(0, 3))
    for rows in _LOWER_LIDS:
        line(rows, 0.4)
    line(slice(60, 65), 0.7)
    line(slice(48, 60), 0.3, closed=True)
    line(slice(31, 36), 0.5)
    line(slice(27, 31), 0.25)
    line(slice(0, 17), 0.5)
    if rng.random() < 0.6:
        extra = rng.integers(0, 6)
        for first, last in _BROWS:
            line(slice(first, last), 1, extra)


def _smooth(points: NDArray[np.float64], closed: bool) -> NDArray[np.float64]:
    if closed:
        return points
    steps, fine = np.arange(len(points)), np.linspace(0, len(points) - 1, 5 * len(points))
    dense = np.column_stack([np.interp(fine, steps, points[:, k]) for k in range(2)])
    dense[1:-1] = (dense[:-2] + 2 * dense[1:-1] + dense[2:]) / 4
    return dense


def rendered_in_style(rng: np.random.Generator, picture: NDArray[np.float32], style: str) -> NDArray[np.float32]:
    """The picture (s, s, 3), 0-255, in a style of `STYLES`."""
    size, bytes_ = len(picture), np.clip(picture, 0, 255).astype(np.uint8)
    if style == "painted":
        return _painted(rng, bytes_)
    if style == "posterized":
        steps = rng.integers(3, 7)
        return np.round(picture / 255 * steps) / steps * 255
    grey = cv2.cvtColor(bytes_, cv2.COLOR_RGB2GRAY)
    if style == "pencil":
        around = np.maximum(cv2.GaussianBlur(grey, (0, 0), between(rng, 1.5, 5) * size / 256), 1)
        line = 255 - np.clip((255 - np.clip(grey / around * 255, 0, 255)) * between(rng, 1, 4), 0, 255)
        keep = 0.0 if rng.random() < 0.6 else 0.3
        return (1 - keep) * _as_rgb(line) + keep * picture
    if style == "ink":
        ink = cv2.adaptiveThreshold(cv2.GaussianBlur(grey, (0, 0), 1.2), 255, cv2.ADAPTIVE_THRESH_MEAN_C, 0, 9, 4)
        paper = picture if rng.random() < 0.6 else _as_rgb(grey.astype(np.float32))
        return np.where(ink[..., None] == 0, paper * between(rng, 0, 0.6), paper)
    if style == "grey":
        return _as_rgb(grey.astype(np.float32))
    return picture.astype(np.float32)


def _painted(rng, picture: NDArray[np.uint8]) -> NDArray[np.float32]:
    size, how = len(picture), rng.random()
    if how < 0.4:
        return cv2.bilateralFilter(picture, 7, between(rng, 30, 90), 7).astype(np.float32)
    if how < 0.7:
        return cv2.medianBlur(picture, int(rng.choice([3, 5]))).astype(np.float32)
    brush = cv2.blur(rng.normal(size=(size, size)).astype(np.float32), (1, 5)) * between(rng, 0, 20)
    return picture + (fractal_noise(rng, size, size) * between(rng, 0, 14) + brush)[..., None]


def _as_rgb(grey: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.repeat(np.asarray(grey, np.float32)[..., None], 3, axis=2)


def developed(rng: np.random.Generator, picture: NDArray[np.float32], landmarks: NDArray[np.float64]):
    """(s, s, 3) uint8: exposure, colour cast, gamma, blur, noise, JPEG."""
    size = len(picture)
    if rng.random() < 0.6:  # the face is exposed well
        low, high = np.clip(landmarks.min(0), 0, size - 9), np.clip(landmarks.max(0), 9, size)
        (x0, y0), (x1, y1) = low.astype(int), high.astype(int)
        dark, bright = np.percentile(picture[y0:y1:2, x0:x1:2], [2, 97])
        picture = (picture - dark) / max(bright - dark, 20) * between(rng, 150, 235) + between(rng, 5, 40)
    if rng.random() < 0.5:  # a cast, or faded colours
        picture = picture * rng.uniform(0.8, 1.15, 3).astype(np.float32)
        grey = picture.mean(2, keepdims=True)
        picture = grey + (picture - grey) * between(rng, 0.3, 1.3)
    picture = 255 * (np.clip(picture, 0, 255) / 255) ** between(rng, 0.55, 1.7)
    picture = (picture - 128) * between(rng, 0.5, 1.25) + 128 + rng.normal(0, 18)
    if rng.random() < 0.4:
        picture = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), between(rng, 0.4, 2.2) * size / 256)
    noise = rng.choice([0, between(rng, 0, 4), between(rng, 0, 10)], p=[0.4, 0.4, 0.2])
    if noise:
        grain = rng.standard_normal((size, size, 1), np.float32)
        picture = picture + grain * np.float32(noise)
    out = np.clip(picture, 0, 255).astype(np.uint8)
    if rng.random() < 0.3:
        quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(15, 80))]
        out = cv2.imdecode(cv2.imencode(".jpg", out, quality)[1], cv2.IMREAD_COLOR)
    return out
