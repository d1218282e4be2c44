"""Eyes as cartoonists draw them, painted over those of a rendered scene, with their exact lids.

The template's lids open and close as people's do. Drawn ones are discs, tall ovals, half discs under a straight lid,
almonds with a lash line as broad as the sclera, arcs of a shut eye; the iris is cut by the lid, the lower line is
missing, the white is skin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from drawn_eye_shape import SAMPLES, DrawnEye, landmark_samples, lid_ring, random_eye
from numpy.typing import NDArray
from renders.canvas import Canvas, between
from renders.scene import Scene

__all__ = ["LID_ROWS", "with_drawn_eyes"]

Floats = NDArray[np.float64]

# Rows of the landmarks of each eye from the viewer's left corner over the upper lid to the right and back.
LID_ROWS = (np.array([36, 37, 38, 39, 40, 41]), np.array([42, 43, 44, 45, 46, 47]))
_BROW_ROWS = (np.arange(17, 22), np.arange(22, 27))
_WHITE = np.array([255.0, 254.0, 250.0])


@dataclass(frozen=True, eq=False)
class _Brow:
    """How both brows are drawn, in px: above the lid, arched, the outer end higher, and never narrower than `least`."""

    gap: float
    arch: float
    tilt: float
    thick: float
    least: float


def with_drawn_eyes(rng: np.random.Generator, scene: Scene) -> Scene:
    """The scene with eyes of a random drawing style; landmarks 36-47 (and of new brows 17-26) are those drawn."""
    picture, points, edges = scene.picture.copy(), scene.landmarks.copy(), scene.edges.copy()
    eye, canvas = random_eye(rng), Canvas(picture)
    cheeks = _skin_near(picture, points)
    line = np.ones(3) * between(rng, 0, 40) if rng.random() < 0.7 else cheeks * between(rng, 0, 0.5)
    iris = rng.uniform(20, 220, 3) * between(rng, 0.2, 1)
    white = _WHITE * between(rng, 0.75, 1) if rng.random() < 0.85 else cheeks
    tall = eye.upper > 0.45  # reaches up to where the brow was
    brow = _random_brow(rng, points) if tall or rng.random() < 0.6 else None
    for outer, rows, brow_rows in zip((-1, 1), LID_ROWS, _BROW_ROWS, strict=True):
        middle, axes, width = _frame(points[rows])
        skin = _skin_near(picture, points[rows], width)
        _erase(canvas, edges, points[rows], None if brow is None else points[brow_rows], skin, width)
        ring = lid_ring(eye, outer)
        placed = middle + (ring * width * eye.across) @ axes
        _paint(rng, canvas, eye, placed, axes, width * eye.across, (line, iris, white, skin))
        points[rows] = placed[landmark_samples()]
        if brow is not None:
            points[brow_rows] = _paint_brow(canvas, brow, placed, axes, outer, line)
    return replace(scene, picture=np.clip(picture, 0, 255), landmarks=points, edges=edges)


def _random_brow(rng: np.random.Generator, points: Floats) -> _Brow:
    width = float(np.mean([np.linalg.norm(points[rows[3]] - points[rows[0]]) for rows in LID_ROWS]))
    shares = between(rng, 0.1, 0.6), rng.normal(0.12, 0.1), rng.normal(0, 0.12), between(rng, 0.05, 0.3), 0.9
    return _Brow(*(share * width for share in shares))


def _frame(lids: Floats) -> tuple[Floats, Floats, float]:
    """Middle (2,) px of a rendered eye, axes (2, 2) along and up, and its width in px."""
    across = lids[3] - lids[0]
    width = max(float(np.linalg.norm(across)), 2.0)
    along = across / width
    return lids.mean(axis=0), np.array([along, [along[1], -along[0]]]), width


def _skin_near(picture, points: Floats, width: float | None = None) -> Floats:
    """Median colour (3,) of the cheek below an eye; of the cheeks for all 68 points."""
    if width is None:
        return (_skin_near(picture, points[36:42], 1) + _skin_near(picture, points[42:48], 1)) / 2
    middle, axes, width = _frame(points)
    x, y = np.rint(middle - 0.9 * width * axes[1]).astype(int)
    reach = max(2, int(0.2 * width))
    part = picture[max(y - reach, 0) : max(y + reach, 1), max(x - reach, 0) : max(x + reach, 1)]
    return np.median(part.reshape(-1, 3), axis=0) if part.size else np.array([200.0, 170.0, 150.0])


def _erase(canvas: Canvas, edges, lids: Floats, brow: Floats | None, skin: Floats, width: float) -> None:
    """Skin where the rendered eye, and the brow if it is given, were."""
    middle = lids.mean(axis=0)
    around = middle + (cv2.convexHull(lids.astype(np.float32))[:, 0] - middle) * [1.35, 2.2]
    areas = [around]
    if brow is not None:
        areas.append(np.vstack([brow - [0, 0.25 * width], brow[::-1] + [0, 0.3 * width]]))
    for area in areas:
        canvas.fill(area, skin, 1, 0.05 * width)
        cv2.fillPoly(edges, [np.rint(area).astype(np.int32)], 0)


def _paint(rng, canvas: Canvas, eye: DrawnEye, ring: Floats, axes: Floats, width: float, colours) -> None:
    line, iris, white, skin = colours
    up = axes[1]
    upper, lower = ring[: SAMPLES + 1], np.vstack([ring[SAMPLES:], ring[:1]])
    if eye.shape == "dot":
        canvas.fill(ring, line, 1, 0.3)
        return
    if eye.shape != "shut":
        _paint_ball(rng, canvas, eye, ring, axes, width, (line, iris, white))
    if eye.shape == "half" or rng.random() < 0.15:  # a lid over the ball
        lid = np.vstack([upper, upper[::-1] + up * width * between(rng, 0.1, 0.4) * _bow(len(upper))])
        canvas.fill(lid, skin * between(rng, 0.6, 0.95), between(rng, 0.4, 1), 0.5)
    if eye.crease:
        raised = upper + up * width * between(rng, 0.08, 0.3)
        canvas.stroke(raised[3:-3], line * 0.5 + skin * 0.5 * between(rng, 0, 1), 1, eye.crease * width, 0.4)
    if eye.under and eye.shape != "shut":
        first = int(rng.integers(0, 10)) if rng.random() < 0.5 else 0
        canvas.stroke(lower[first : len(lower) - first // 2], line, between(rng, 0.5, 1), eye.under * width, 0.4)
    if eye.lash or eye.shape == "shut":
        _paint_lash(canvas, eye, upper, up, width, line)
    for k in np.linspace(2, SAMPLES - 2, eye.spikes).astype(int):
        aside = np.sign(k - SAMPLES / 2) * axes[0] * between(rng, 0, 0.12)
        tip = upper[k] + (up * between(rng, 0.1, 0.22) + aside) * width
        canvas.stroke([upper[k], tip], line, 1, 0.03 * width, 0.3)


def _paint_ball(rng, canvas: Canvas, eye: DrawnEye, ring: Floats, axes: Floats, width: float, colours) -> None:
    """White, iris, pupil and glints inside the ring; the lid cuts what is larger."""
    line, iris, white = colours
    height, wide = canvas.picture.shape[:2]
    inside = np.zeros((height, wide), np.float32)
    cv2.fillPoly(inside, [np.rint(ring * 8).astype(np.int32)], 1, 16, 3)
    layer = Canvas(canvas.picture.copy())
    layer.picture[:] = white
    middle = (ring.max(axis=0) + ring.min(axis=0)) / 2 + (eye.gaze * width) @ axes
    radius = eye.iris * width
    tall = between(rng, 1.0, 1.4)
    if rng.random() < 0.9:
        layer.ellipse(middle, (radius * 1.08, radius * 1.08 * tall), line, between(rng, 0, 1), 0.4)
        layer.ellipse(middle, (radius, radius * tall), iris, 1, 0.4)
    pupil = radius * between(rng, 0.3, 0.75)
    layer.ellipse(middle, (pupil, pupil * tall), np.zeros(3) + between(rng, 0, 30), 1, 0.4)
    for _ in range(int(rng.integers(0, 3))):
        at = middle + rng.normal(0, 0.35 * radius, 2)
        glint = radius * between(rng, 0.1, 0.4)
        layer.ellipse(at, (glint, glint * between(rng, 0.7, 1.3)), _WHITE, between(rng, 0.6, 1), 0.3)
    if rng.random() < 0.4:  # the shadow of the lid
        shade = ring[: SAMPLES + 1] - axes[1] * width * between(rng, 0.02, 0.12)
        layer.stroke(shade, line, between(rng, 0.1, 0.5), 0.12 * width, 0.05 * width)
    canvas.picture += inside[..., None] * (layer.picture - canvas.picture)


def _paint_lash(canvas: Canvas, eye: DrawnEye, upper: Floats, up: Floats, width: float, line: Floats) -> None:
    """The upper line, thickest where the lid is highest."""
    thick = max(eye.lash, 0.03) * width
    shape = np.linspace(0.5, 1, len(upper))[:, None] * _bow(len(upper)) ** 0.5 + 0.15
    centre = upper + up * thick * (0 if eye.shape == "shut" else eye.outwards)
    area = np.vstack([centre + up * thick / 2 * shape, (centre - up * thick / 2 * shape)[::-1]])
    canvas.fill(area, line, 1, 0.4)


def _bow(count: int) -> Floats:
    """(count, 1): 0 at the ends, 1 in the middle."""
    return np.sin(np.linspace(0, np.pi, count))[:, None]


def _paint_brow(canvas: Canvas, brow: _Brow, ring: Floats, axes: Floats, outer: int, colour: Floats) -> Floats:
    """A brow above the ring; its five landmarks (5, 2) px, on the upper half of the stroke."""
    placed = (ring - ring.mean(axis=0)) @ axes.T
    x = np.linspace(-0.6, 0.6, 5) * max(np.ptp(placed[:, 0]), brow.least)
    share = x / x[-1]
    y = placed[:, 1].max() + brow.gap + brow.arch * (1 - share**2) + brow.tilt * outer * share
    line = ring.mean(axis=0) + np.column_stack([x, y]) @ axes
    profile = np.array([0.4, 0.8, 1, 1, 0.7])[::-outer][:, None] * brow.thick * axes[1]
    canvas.fill(np.vstack([line + 0.4 * profile, (line - 0.6 * profile)[::-1]]), colour, 1, 0.4)
    return line
