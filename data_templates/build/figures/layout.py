"""Where a drawn face has its features: the landmarks of a random head, moved to a cartoon's proportions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from renders.canvas import between
from renders.random_head import random_head
from renders.template import template
from renders.view import random_view

from toongeo.geometry.operators.vertex_normals import vertex_normals

__all__ = ["Layout", "random_layout"]

Floats = NDArray[np.float64]

_JAW, _RIGHT_EYE, _LEFT_EYE, _BROWS = slice(0, 17), slice(36, 42), slice(42, 48), (slice(17, 22), slice(22, 27))
# Places of the mouth's twenty points along it, from corner to corner; the first twelve are the outer contour.
_ALONG = np.array([-1, -0.62, -0.25, 0, 0.25, 0.62, 1, 0.62, 0.25, 0, -0.25, -0.62])
_ALONG_WITHIN = np.array([-0.88, -0.35, 0, 0.35, 0.88, 0.35, 0, -0.35])
_YAW = 36.0  # degrees: cartoons are seen from the front or in three-quarter view; profiles are drawn otherwise
_GAP = 0.05  # radii that nose, mouth and chin keep from each other


@dataclass(frozen=True, eq=False)
class Layout:
    """`points` (68, 2) in radii of the face from the middle of the eyes, x along the line of the eyes, y down; the
    `corner` (2,) px of that middle, `axes` (2, 2) px of x and y; the `yaw` in degrees, and how wide the mouth stands
    `open`, in its own width."""

    points: Floats
    corner: Floats
    axes: Floats
    yaw: float
    open: float

    def placed(self, points) -> Floats:
        """Points (k, 2) in px."""
        return self.corner + np.asarray(points, float) @ self.axes


def random_layout(rng: np.random.Generator, size: int, extent=(0.155, 0.195)) -> Layout:
    """A layout in a picture of so many px."""
    head = random_head(rng, "cartoon")
    count = len(template().model.mean)
    normals = vertex_normals(head.vertices, template().faces)[:count]
    while True:
        view, rows = random_view(rng, head.vertices[:count], normals, size, extent)
        if abs(view.yaw) < _YAW:
            break
    seen = view.projected(head.vertices[rows])[:, :2]
    eyes = seen[_RIGHT_EYE].mean(axis=0), seen[_LEFT_EYE].mean(axis=0)
    corner, along = (eyes[0] + eyes[1]) / 2, eyes[1] - eyes[0]
    along = along / max(np.linalg.norm(along), 1e-6)
    radius = np.sqrt(((seen - seen.mean(axis=0)) ** 2).sum(axis=1).mean())
    axes = radius * np.array([along, [-along[1], along[0]]])
    points = (seen - corner) @ np.linalg.inv(axes)
    _move_eyes(rng, points)
    _move_brows(rng, points)
    mouth = points[48:68].mean(axis=0)
    mouth[1] += rng.normal(0, 0.12)
    _move_nose(rng, points, mouth[1])
    open_ = _move_mouth(rng, points, mouth)
    _move_jaw(rng, points)
    spread = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
    return Layout(points, corner, axes / spread, view.yaw, open_)


def _move_eyes(rng, points: Floats) -> None:
    size, apart, drop = between(rng, 0.85, 1.25), between(rng, 0.85, 1.2), rng.normal(0, 0.06)
    for rows in (_RIGHT_EYE, _LEFT_EYE):
        middle = points[rows].mean(axis=0)
        points[rows] = middle * [apart, 1] + [0, drop] + (points[rows] - middle) * size


def _move_brows(rng, points: Floats) -> None:
    rise, arch, tilt, stretch = (
        between(rng, -0.2, 0.06),
        rng.normal(0, 0.04),
        rng.normal(0, 0.05),
        between(rng, 0.8, 1.25),
    )
    for side, rows in zip((-1, 1), _BROWS, strict=True):
        x = np.linspace(-1, 1, 5)
        middle = points[rows].mean(axis=0)
        points[rows] = middle + (points[rows] - middle) * [stretch, between(rng, 0.2, 1.3)]
        points[rows, 1] += rise - arch * (1 - x**2) - tilt * side * x


def _move_nose(rng, points: Floats, mouth_y: float) -> None:
    """From a stroke to a potato, anywhere between the eyes and the mouth."""
    size = np.exp(between(rng, np.log(0.12), np.log(1.3)))
    base, tip = points[33].copy(), points[30].copy()
    place = between(rng, 0.35, 0.85) * mouth_y
    aside = base[0] * place / max(base[1], 0.1)  # a turned face keeps its slant
    moved = np.array([aside, place])
    points[31:36] = moved + (points[31:36] - base) * [size * between(rng, 0.7, 1.3), size]
    # Annotators keep the tip apart from the base, and begin at the height of the eyes, however short the nose is.
    points[30] = moved + [(tip - base)[0] * size, -place * between(rng, 0.08, 0.3)]
    top = [aside * 0.3, rng.normal(0, 0.05) * place] if rng.random() < 0.7 else points[30] * between(rng, 0.05, 0.5)
    points[27:31] = top + np.outer([0, 1 / 3, 2 / 3, 1], points[30] - top)


def _move_mouth(rng, points: Floats, middle: Floats) -> float:
    """A new mouth at `middle`: how it opens, bends and bulges. Returns the height of its opening over its width."""
    half = np.linalg.norm(points[54] - points[48]) / 2 * np.exp(between(rng, np.log(0.35), np.log(1.5)))
    middle[1] = max(middle[1], points[31:36, 1].max() + _GAP + 0.15 * half)
    bend, tilt, kind = rng.normal(-0.12, 0.22), rng.normal(0, 0.06), rng.random()
    upper, lower = (
        (between(rng, 0.08, 0.28), between(rng, 0.1, 0.4)) if kind < 0.5 else np.full(2, between(rng, 0.03, 0.08))
    )
    open_ = 0.0 if rng.random() < 0.6 else between(rng, 0.1, 1.0)
    above = between(rng, 0, 0.6) if bend > 0 else between(rng, 0, 0.3)
    sag = between(rng, 1.4, 3.0)  # exponent of the contour of the opening

    def line(x):
        return bend * (x**2 - 0.5) + tilt * x

    gap = open_ * np.maximum(1 - np.abs(_ALONG_WITHIN / 0.88) ** sag, 0)
    sign = np.array([0, -1, -1, -1, 0, 1, 1, 1])
    share = np.where(sign < 0, above, 1 - above)
    within = np.column_stack([_ALONG_WITHIN, line(_ALONG_WITHIN) + sign * share * gap])
    gap = open_ * np.maximum(1 - np.abs(_ALONG) ** sag, 0)
    bulge = 1 - np.abs(_ALONG) ** 1.8
    bow = 1 - between(rng, 0, 0.35) * np.exp(-((_ALONG / 0.15) ** 2))  # the dip of the upper lip
    up = np.arange(12) <= 6
    y = np.where(up, -above * gap - upper * bulge * bow, (1 - above) * gap + lower * bulge)
    outer = np.column_stack([_ALONG, line(_ALONG) + y])
    points[48:68] = middle + half * np.vstack([outer, within])
    return open_


def _move_jaw(rng, points: Floats) -> None:
    """A chin that is long, short, broad or pointed; cheeks that bulge."""
    jaw = points[_JAW].copy()
    low = points[48:60, 1].max()
    chin = max(jaw[8, 1] * np.exp(rng.normal(0, 0.12)), low + _GAP + 0.1 * abs(rng.normal()))
    t = np.linspace(0, 1, 17)
    if rng.random() < 0.5:  # a superellipse between the ears as they are
        angle, power = np.pi * (t * (1 + 2 * 0.04) - 0.04), between(rng, 1.5, 3.2)
        x, y = (np.sign(f) * np.abs(f) ** (2 / power) for f in (-np.cos(angle), np.sin(angle)))
        start = (jaw[0, 1] + jaw[16, 1]) / 2
        middle = jaw[8, 0] + (jaw[0, 0] + jaw[16, 0] - 2 * jaw[8, 0]) / 2 * (1 - np.clip(y, 0, 1))
        reach = np.where(x < 0, middle - jaw[0, 0], jaw[16, 0] - middle)
        jaw = np.column_stack([middle + x * np.maximum(reach, 0.1), start + y * (chin - start)])
    else:
        jaw[:, 1] = np.where(jaw[:, 1] > 0, jaw[:, 1] * chin / max(jaw[8, 1], 0.1), jaw[:, 1])
    height = np.clip(jaw[:, 1] / chin, 0, 1)
    wide, bulge, point = rng.normal(0, 0.12), rng.normal(0, 0.15), rng.normal(0, 0.2)
    factor = np.exp(wide + bulge * np.sin(np.pi * height) - point * height**3)
    jaw[:, 0] = jaw[8, 0] + (jaw[:, 0] - jaw[8, 0]) * factor
    points[_JAW] = jaw
