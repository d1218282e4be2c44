"""What lies behind a head: paper, studio grounds, paint, out-of-focus scenes, rooms and patterns."""

from __future__ import annotations

import cv2
import numpy as np
from noise import Floats, Rng, chance, clouds, smooth_field

__all__ = ["random_ground"]


def random_ground(rng: Rng, side: int, hair: Floats, drawn: bool) -> Floats:
    """Ground (side, side, 3) float32, 0-255; ``hair`` (3,) is the hair's colour, which grounds sometimes share."""
    kinds = {
        _plain: 0.34 if drawn else 0.14,
        _studio: 0.24,
        _painted: 0.20,
        _scene: 0.14 if drawn else 0.3,
        _shapes: 0.08 if drawn else 0.12,
    }
    weights = np.array(list(kinds.values()))
    kind = list(kinds)[int(rng.choice(len(kinds), p=weights / weights.sum()))]
    return np.clip(kind(rng, side, _base(rng, hair)), 0, 255).astype(np.float32)


def _base(rng: Rng, hair: Floats) -> Floats:
    """A colour: muted mostly, at times the hair's own, or white or black."""
    kind = rng.random()
    if kind < 0.18:
        return (hair * rng.uniform(0.5, 1.5) + rng.normal(0, 10, 3)).astype(np.float32)
    grey = rng.uniform(10, 245)
    chroma = rng.choice([10, 25, 60], p=[0.5, 0.3, 0.2])
    return np.clip(grey + rng.normal(0, chroma, 3), 0, 255).astype(np.float32)


def _plain(rng: Rng, side: int, base: Floats) -> Floats:
    colour = base if chance(rng, 0.4) else np.full(3, rng.choice([255.0, 252.0, 245.0]), np.float32)
    ground = np.broadcast_to(colour, (side, side, 3)).astype(np.float32)
    if chance(rng, 0.15):  # a frame
        ground = ground.copy()
        cv2.rectangle(ground, (0, 0), (side - 1, side - 1), tuple(float(c) for c in rng.uniform(0, 255, 3)), 5)
    return ground


def _studio(rng: Rng, side: int, base: Floats) -> Floats:
    """A gradient, a vignette or a halo, with a little grain."""
    y, x = (np.mgrid[:side, :side] / side - 0.5).astype(np.float32)
    kind = rng.random()
    if kind < 0.5:
        angle = rng.uniform(0, 2 * np.pi)
        level = x * np.cos(angle) + y * np.sin(angle)
    else:
        level = 0.5 - np.hypot(x - rng.normal(0, 0.1), y - rng.normal(0, 0.1)) * rng.choice([-1, 1], p=[0.25, 0.75])
    level = level + 0.15 * smooth_field(rng, (side, side), 4) * rng.uniform(0, 1)
    other = base * rng.uniform(0.2, 1.0) + rng.normal(0, 20, 3)
    t = np.clip(0.5 + level * rng.uniform(0.5, 2.0), 0, 1)[..., None].astype(np.float32)
    return base * t + other.astype(np.float32) * (1 - t) + rng.normal(0, rng.uniform(0, 3), (side, side, 1))


def _painted(rng: Rng, side: int, base: Floats) -> Floats:
    """Brush strokes, sponge and scratches of two or three related tones."""
    shape = (side, side)
    ground = np.broadcast_to(base, (side, side, 3)).astype(np.float32)
    for _ in range(int(rng.integers(1, 4))):
        tone = base * rng.uniform(0.5, 1.4) + rng.normal(0, 18, 3)
        cover = clouds(rng, shape, rng.uniform(0.5, 0.95))
        if chance(rng, 0.6):  # drawn out along the stroke
            angle = rng.uniform(0, 180)
            kernel = np.zeros((31, 31), np.float32)
            reach = 15 * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
            start, end = (15 - reach).astype(int), (15 + reach).astype(int)
            cv2.line(kernel, tuple(map(int, start)), tuple(map(int, end)), 1.0, 1)
            grain = rng.normal(0, 1, shape).astype(np.float32)
            strokes = cv2.filter2D(grain, -1, kernel / kernel.sum())
            cover = cover + strokes / strokes.std() * rng.uniform(0.2, 1.0)
        share = (1 / (1 + np.exp(-rng.uniform(1, 6) * (cover - rng.uniform(-0.5, 0.8)))))[..., None]
        ground = ground * (1 - share) + tone.astype(np.float32) * share
    if chance(rng, 0.5):
        y, x = np.mgrid[:side, :side] / side - 0.5
        ground = ground * (1 - rng.uniform(0.3, 1.3) * (x**2 + y**2))[..., None]
    return ground


def _scene(rng: Rng, side: int, base: Floats) -> Floats:
    """Occluding shapes of all sizes (dead leaves, Lee, Mumford and Huang 2001), textured, mostly out of focus."""
    ground = base + clouds(rng, (side, side), 0.7)[..., None] * rng.uniform(5, 40)
    ground = np.ascontiguousarray(ground, np.float32)
    palette = np.clip(base * rng.uniform(0.3, 1.5, (6, 1)) + rng.normal(0, 35, (6, 3)), 0, 255)
    for _ in range(int(rng.integers(10, 120))):
        radius = min(6.0 / (1 - rng.random()) ** 0.7, 0.35 * side)
        middle = rng.uniform(0, side, 2)
        corners = int(rng.integers(3, 9))
        angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
        ring = middle + radius * rng.uniform(0.5, 1.2, (corners, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
        colour = palette[rng.integers(6)] * rng.uniform(0.8, 1.2) + rng.normal(0, 8, 3)
        cv2.fillPoly(ground, [np.rint(ring).astype(np.int32)], tuple(float(c) for c in colour), cv2.LINE_AA)
    if chance(rng, 0.5):  # upright things: walls, doors, flags, trunks
        for _ in range(int(rng.integers(1, 7))):
            x, width = rng.uniform(0, side), rng.uniform(4, 0.3 * side)
            colour = palette[rng.integers(6)] * rng.uniform(0.7, 1.3)
            lean = rng.normal(0, 0.08 * side)
            strip = np.array([[x, 0], [x + width, 0], [x + width + lean, side], [x + lean, side]])
            cv2.fillPoly(ground, [np.rint(strip).astype(np.int32)], tuple(float(c) for c in colour), cv2.LINE_AA)
    if chance(rng, 0.75):
        ground = cv2.GaussianBlur(ground, (0, 0), rng.uniform(1, 9))
    return ground + clouds(rng, (side, side), 0.9)[..., None] * rng.uniform(0, 10)


def _shapes(rng: Rng, side: int, base: Floats) -> Floats:
    """Stripes, dots, rays or letters on one colour."""
    y, x = np.mgrid[:side, :side].astype(np.float32)
    angle, period = rng.uniform(0, np.pi), rng.uniform(8, 70)
    kind = rng.integers(3)
    if kind == 0:
        level = np.sin((x * np.cos(angle) + y * np.sin(angle)) * 2 * np.pi / period)
    elif kind == 1:
        level = np.sin(x * 2 * np.pi / period) * np.sin(y * 2 * np.pi / period)
    else:
        middle = side * rng.uniform(0.3, 0.7, 2)
        level = np.sin(np.arctan2(y - middle[1], x - middle[0]) * rng.integers(4, 20))
    other = np.clip(base + rng.normal(0, 50, 3), 0, 255)
    ground = np.where((level > rng.uniform(-0.3, 0.6))[..., None], other, base).astype(np.float32)
    letters = np.zeros((side, side), np.uint8)
    for _ in range(int(rng.integers(0, 4))):
        place = int(rng.uniform(0, 0.8 * side)), int(rng.uniform(0.05, 0.95) * side)
        cv2.putText(letters, "abc XYZ"[: rng.integers(2, 8)], place, 0, rng.uniform(0.5, 2.5), 255, 3, cv2.LINE_AA)
    cover = letters[..., None].astype(np.float32) / 255
    ground = ground * (1 - cover) + cover * rng.uniform(0, 255, 3).astype(np.float32)
    return ground
