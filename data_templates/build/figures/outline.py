"""The outline of a drawn head, its ears, hair and shades."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from renders.canvas import Canvas, between
from renders.palette import Palette
from renders.scene import Part
from scipy.interpolate import CubicSpline

from figures.layout import Layout

__all__ = ["Line", "paint_behind", "paint_face", "paint_hair", "smooth_curve"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Line:
    """The pen: its `colour` (3,), and `width` px; 0 draws no outlines."""

    colour: Floats
    width: float

    def draw(self, canvas: Canvas, points: Floats, factor: float = 1.0, closed: bool = False) -> None:
        """A line through points (k, 2) px, so many times as broad as the pen."""
        if self.width:
            canvas.stroke(points, self.colour, 1, self.width * factor, 0.3, closed=closed)


def smooth_curve(points, closed: bool = False, fine: int = 6) -> Floats:
    """A cubic spline through points (k, 2), so many samples a piece."""
    points = np.asarray(points, float)
    if closed:
        points = np.vstack([points, points[:1]])
    spline = CubicSpline(np.arange(len(points)), points, bc_type="periodic" if closed else "natural")
    return spline(np.linspace(0, len(points) - 1, fine * (len(points) - 1) + (not closed), endpoint=not closed))


def _skull(layout: Layout, high: float, wide: float = 1.0) -> Floats:
    """From the last point of the jaw over the top of the head to the first, (k, 2) radii."""
    first, last = layout.points[0], layout.points[16]
    angle = np.linspace(0, np.pi, 25)[1:-1]
    middle, half = (first + last) / 2, (last[0] - first[0]) / 2 * wide
    slant = (last[1] - first[1]) / 2 * np.cos(angle)
    return np.column_stack([middle[0] + half * np.cos(angle), middle[1] + slant - high * np.sin(angle)])


def paint_behind(rng, canvas: Canvas, layout: Layout, palette: Palette, line: Line, high: float) -> None:
    """Hair behind the head, the neck, ears."""
    first, last, chin = layout.points[0], layout.points[16], layout.points[8]
    half, middle = (last[0] - first[0]) / 2, (last[0] + first[0]) / 2
    if rng.random() < 0.5:
        wide, low = half * between(rng, 1.1, 1.8), chin[1] * between(rng, 0.3, 1.8)
        ring = [(-0.7, -high), (0, -1.12 * high), (0.7, -high), (1, 0), (between(rng, 0.7, 1.3), low)]
        ring += [(between(rng, -0.6, 0.6), low * between(rng, 0.8, 1)), (between(rng, -1.3, -0.7), low), (-1, 0)]
        ring = layout.placed(smooth_curve(np.array(ring) * [wide, 1] + [middle, 0], closed=True))
        canvas.fill(ring, palette.hair * between(rng, 0.6, 1), label=Part.HAIR)
        line.draw(canvas, ring, closed=True)
    neck = half * between(rng, 0.35, 0.7)
    sides = [(middle - neck, 0.5 * chin[1]), (middle + neck, 0.5 * chin[1])]
    low = chin[1] + 3
    ring = layout.placed([*sides, (middle + neck * 1.1, low), (middle - neck * 1.1, low)])
    canvas.fill(ring, palette.skin * between(rng, 0.7, 1), label=Part.SKIN)
    line.draw(canvas, ring[1:3])
    line.draw(canvas, ring[[0, 3]])
    size = half * between(rng, 0.12, 0.35)
    for root, side in ((layout.points[1], -1), (layout.points[15], 1)):
        angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
        ring = root + np.column_stack([np.cos(angle) * size * 0.7 + side * 0.3 * size, np.sin(angle) * size])
        canvas.fill(layout.placed(ring), palette.skin * between(rng, 0.85, 1), label=Part.SKIN)
        line.draw(canvas, layout.placed(ring), closed=True)


def paint_face(rng, canvas: Canvas, layout: Layout, palette: Palette, line: Line, high: float) -> None:
    """Skin with its shades, and the line around it."""
    jaw = smooth_curve(layout.points[:17])
    ring = layout.placed(np.vstack([jaw, _skull(layout, high)]))
    canvas.fill(ring, palette.skin, label=Part.SKIN)
    if rng.random() < 0.5:
        _paint_shade(rng, canvas, layout, palette, ring)
    if rng.random() < 0.3:
        for rows in (slice(36, 42), slice(42, 48)):
            cheek = layout.points[rows].mean(axis=0) + [0, between(rng, 0.35, 0.6)]
            radius = between(rng, 0.1, 0.25) * np.linalg.norm(layout.axes[0])
            colour = palette.skin * [1, 0.75, 0.72]
            canvas.ellipse(layout.placed([cheek])[0], (radius, 0.7 * radius), colour, 0.8, between(rng, 0.3, 6))
    line.draw(canvas, layout.placed(jaw), between(rng, 0.6, 1.4))
    if rng.random() < 0.5:
        line.draw(canvas, ring, closed=True)


def _paint_shade(rng, canvas: Canvas, layout: Layout, palette: Palette, ring: Floats) -> None:
    """A shade along one side, sharp as in a cel or soft as from an airbrush."""
    height, width = canvas.picture.shape[:2]
    face, lit = np.zeros((2, height, width), np.float32)
    radius = np.linalg.norm(layout.axes[0])
    away = np.array([rng.choice([-1, 1]) * between(rng, 0.05, 0.5), -between(rng, 0, 0.3)]) * radius
    for mask, polygon in ((face, ring), (lit, ring + away)):
        cv2.fillPoly(mask, [np.rint(polygon * 8).astype(np.int32)], 1, 16, 3)
    shade = np.clip(face - lit, 0, 1)
    if rng.random() < 0.5:
        shade = cv2.GaussianBlur(shade, (0, 0), between(rng, 0.05, 0.3) * radius) * face
    colour = palette.skin * [between(rng, 0.6, 0.95), between(rng, 0.55, 0.9), between(rng, 0.55, 0.9)]
    canvas.picture += shade[..., None] * (colour - canvas.picture).astype(np.float32)


def paint_hair(rng, canvas: Canvas, layout: Layout, palette: Palette, line: Line, high: float) -> None:
    """Hair over the forehead and down the sides."""
    first, last = layout.points[0], layout.points[16]
    left, right = first + [0, between(rng, -0.5, 0.1)], last + [0, between(rng, -0.5, 0.1)]
    cap = _skull(layout, high * between(rng, 1.05, 1.45), between(rng, 1.03, 1.25))
    along = np.linspace(0, 1, 13)[1:-1, None]
    brow = layout.points[17:27, 1].min()
    edge = (
        between(rng, 0.15, 0.85) * (high - abs(brow)) if rng.random() < 0.85 else -0.1
    )  # above the brows, or over them
    arch = np.column_stack(
        [np.zeros(11), (brow - edge - (left[1] + right[1]) / 2) * np.sin(np.pi * along[:, 0]) ** 0.5]
    )
    fringe = left + (right - left) * along + arch
    how = rng.random()
    if how < 0.3:  # locks
        fringe[:, 1] += np.where(np.arange(11) % 2, 1, -1) * between(rng, 0.02, 0.15)
    elif how < 0.5:  # a parting
        at = rng.integers(2, 9)
        fringe[:, 1] -= 0.6 * max(edge, 0.1) * np.exp(-((np.arange(11) - at) ** 2) / 6)
    hair_line = np.vstack([[left], fringe, [right]])
    hair_line = hair_line if how < 0.3 and rng.random() < 0.6 else smooth_curve(hair_line)
    ring = layout.placed(np.vstack([cap, hair_line]))
    canvas.fill(ring, palette.hair, label=Part.HAIR)
    if rng.random() < 0.4:
        _paint_sheen(rng, canvas, layout, palette, cap)
    line.draw(canvas, ring, closed=True)
    if rng.random() < 0.35:
        for root, side in ((left, -1), (right, 1)):
            low, inwards = layout.points[8, 1] * between(rng, 0.2, 1.4), between(rng, 0, 0.2)
            lock = [root + [-0.2 * side, -0.3], root + [-inwards * side, 0.4 * low], root + [0.05 * side, low]]
            lock += [root + [0.25 * side, 0.5 * low], root + [0.15 * side, -0.3]]
            ring = layout.placed(smooth_curve(lock, closed=True))
            canvas.fill(ring, palette.hair * between(rng, 0.85, 1), label=Part.HAIR)
            line.draw(canvas, ring, closed=True)


def _paint_sheen(rng, canvas: Canvas, layout: Layout, palette: Palette, cap: Floats) -> None:
    """Strands, darker or lighter."""
    for _ in range(int(rng.integers(2, 14))):
        root = cap[rng.integers(3, len(cap) - 3)] * 0.97
        tip = root * [between(rng, 0.5, 0.9), between(rng, 0.6, 0.8)]
        middle = (root + tip) / 2 + rng.normal(0, 0.04, 2)
        shade = palette.hair * between(rng, 0.4, 1.6)
        canvas.stroke(layout.placed(smooth_curve([root, middle, tip])), shade, between(rng, 0.3, 1), rng.integers(1, 4))
