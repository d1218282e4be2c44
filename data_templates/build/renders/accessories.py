"""Glasses, hats and hands over a face."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renders.canvas import Canvas, between
from renders.palette import random_colour

__all__ = ["paint_glasses", "paint_hand", "paint_hat"]


def paint_glasses(rng, canvas: Canvas, points: NDArray[np.float64], label: int) -> None:
    """Round, square or dark glasses on the 68 points (68, 2) px."""
    size = len(canvas.picture)
    colour = np.ones(3) * rng.choice([15.0, 60.0, 120.0]) if rng.random() < 0.8 else random_colour(rng)
    width, dark, power = size * between(rng, 0.004, 0.018), rng.random() < 0.15, rng.choice([2.0, 2.0, 4.0])
    stretch, height = between(rng, 1.1, 1.7), np.linalg.norm(points[36] - points[45]) * 0.165 * between(rng, 0.75, 1.3)
    bridge = []
    for first, sign in ((36, 1), (42, -1)):
        along = points[first + 3] - points[first]
        half = max(np.linalg.norm(along) * 0.55 * stretch, 2)
        along = along / max(np.linalg.norm(along), 1)
        across = np.array([-along[1], along[0]])
        middle = points[first : first + 6].mean(0) + across * 0.1 * height
        angles = np.linspace(0, 2 * np.pi, 28, endpoint=False)
        x, y = (np.sign(f) * np.abs(f) ** (2 / power) for f in (np.cos(angles), np.sin(angles)))
        ring = middle + np.outer(x * half, along) + np.outer(y * height, across)
        if dark:
            canvas.fill(ring, (22, 20, 20), between(rng, 0.75, 1), label=label)
        elif rng.random() < 0.3:  # a reflection
            canvas.fill(ring[3:12], (255, 255, 255), between(rng, 0.1, 0.5), 1)
        canvas.stroke(ring, colour, 1, width, closed=True, label=label)
        bridge.append(middle + sign * along * half)
        if rng.random() < 0.7:
            jaw = points[0 if first == 36 else 16]
            canvas.stroke([middle - sign * along * half, jaw + (points[27] - jaw) * 0.1], colour, 1, width)
    canvas.stroke(bridge, colour, 1, width, label=label)


def paint_hat(rng, canvas: Canvas, points: NDArray[np.float64], label: int) -> None:
    """A hat or a cap above the brows."""
    up = points[27] - points[30]
    up = up / (np.linalg.norm(up) + 1e-9)
    across, eyes = np.array([-up[1], up[0]]), np.linalg.norm(points[36] - points[45])
    base, half = points[17:27].mean(0) + up * eyes * between(rng, 0.3, 0.65), eyes * between(rng, 1.1, 1.7)
    top, taper = up * eyes * between(rng, 0.8, 2), between(rng, 0.5, 1)
    ring = [base - across * half, base - across * half * taper + top, base + across * half * taper + top]
    ring += [base + across * half]
    colour = random_colour(rng)
    if rng.random() < 0.5:
        ring = [*ring[:2], (ring[1] + ring[2]) / 2 + up * eyes * 0.4, *ring[2:]]
    canvas.fill(ring, colour, label=label)
    brim = np.array([ring[0] - across * half * 0.25, base - up * eyes * between(rng, -0.1, 0.15), ring[-1]])
    brim[2] += across * half * 0.25
    wide = len(canvas.picture) * between(rng, 0.01, 0.055)
    canvas.stroke(brim, colour * between(rng, 0.4, 1.3), 1, wide, label=label)


def paint_hand(rng, canvas: Canvas, points: NDArray[np.float64], skin: NDArray[np.float64], label: int) -> None:
    """Fingers at the chin or the cheek."""
    eyes = np.linalg.norm(points[36] - points[45])
    root = points[rng.choice([3, 4, 6, 8, 10, 12, 13])] + rng.normal(0, 0.15 * eyes, 2)
    towards = points[30] - root
    towards = towards / (np.linalg.norm(towards) + 1e-9)
    side, shade = np.array([-towards[1], towards[0]]), skin * between(rng, 0.75, 1.1)
    palm = root - towards * eyes * 0.9
    canvas.stroke([palm, root - towards * eyes * 0.2], shade, 1, 0.7 * eyes, label=label)
    for k in range(int(rng.integers(2, 5))):
        start = root - towards * eyes * 0.3 + side * eyes * 0.17 * (k - 1.5)
        end = start + towards * eyes * between(rng, 0.3, 0.7)
        canvas.stroke([start, end], shade * 0.6, 1, 0.2 * eyes)
        canvas.stroke([start, end], shade, 1, 0.17 * eyes, label=label)
