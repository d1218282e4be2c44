"""One texture atlas for the whole head: the source's UV islands, turned upright, warped and packed anew."""

from __future__ import annotations

import numpy as np
from cage import PARTS
from cartogram import cartogram
from head import Head, Teeth
from scipy.interpolate import PchipInterpolator
from source import Floats, Ints

# Rectangles (u0, v0, u1, v1) of the islands; each island keeps its aspect and is centred in its rectangle.
_RECTANGLES = {
    "skin": (0.008, 0.385, 0.992, 0.992),
    "neck": (0.385, 0.145, 0.855, 0.375),
    "mouth_cavity": (0.01, 0.01, 0.25, 0.185),
    "socket_left": (0.27, 0.01, 0.36, 0.125),
    "socket_right": (0.375, 0.01, 0.465, 0.125),
    "tongue": (0.88, 0.145, 0.99, 0.375),
    "teeth_upper": (0.49, 0.075, 0.99, 0.13),
    "teeth_lower": (0.49, 0.01, 0.99, 0.065),
}
_EYE_DISCS = {"left": (0.0975, 0.2825), "right": (0.2825, 0.2825)}
_EYE_RADIUS = 0.0875
# Share of the length on the face that a millimetre gets behind it, and on the ears of that; and the limits
# within which areas may change against each other.
_OFF_FACE, _EARS = 0.45, 0.5
_MOST_CHANGE = (0.3, 4.0)
# Monotone warps of the skin island, (from, to) in source UV units: the face keeps its size, ears, the back of
# the head and the underside of the jaw shrink. Sideways from the middle line; upwards from the lower border.
_WIDTH_WARP = ((0.0, 0.0), (0.06, 0.06), (0.115, 0.115), (0.18, 0.154), (0.26, 0.182), (0.335, 0.208))
_HEIGHT_WARP = (
    (0.0, 0.0),
    (0.03, 0.021),
    (0.06, 0.049),
    (0.19, 0.179),
    (0.24, 0.214),
    (0.3, 0.239),
    (0.353, 0.257),
)


def atlas(head: Head, teeth: dict[str, Teeth], masks: dict[str, Floats]) -> tuple[Floats, Ints]:
    """UV (t0, 2) of the L0 cage and its `uv_quads` (q, 4), quads in the order of the head."""
    uv, quads, n = [], [], 0
    for name in PARTS:
        if name in teeth:
            points, corners = teeth[name].uv, teeth[name].quads
            if _signed_area(points[corners]) < 0:
                points = points * [1, -1]
        else:
            ids, corners = np.unique(head.cage.uv_quads[name], return_inverse=True)
            corners = corners.reshape(-1, 4)
            points = head.cage.uv[ids]
            if name == "skin":
                points = _upright(points)
                points = cartogram(points, *_wanted_density(points[corners], head, masks))
        uv.append(_fitted(points, _RECTANGLES[name], stretch=name in teeth))
        quads.append(corners.reshape(-1, 4) + n)
        n += len(points)
    return np.vstack(uv), np.vstack(quads)


def eye_uv(disc: Floats) -> Floats:
    """Atlas UV (2, k, 2) of the left and right eyeball from coordinates (k, 2) in the unit disc."""
    return np.stack([np.array(_EYE_DISCS[side]) + _EYE_RADIUS * disc for side in ("left", "right")])


def _upright(uv: Floats) -> Floats:
    """The skin island lies on its side in the source: turn it by a quarter, then warp it."""
    sideways = uv[:, 1] - (uv[:, 1].min() + uv[:, 1].max()) / 2
    up = uv[:, 0].max() - uv[:, 0]
    width, height = (
        PchipInterpolator(*zip(*_WIDTH_WARP, strict=True)),
        PchipInterpolator(*zip(*_HEIGHT_WARP, strict=True)),
    )
    return np.column_stack([np.sign(sideways) * width(np.abs(sideways)), height(up)])


def _wanted_density(quads_uv: Floats, head: Head, masks: dict[str, Floats]) -> tuple[Floats, Floats]:
    """Centres (q, 2) of the skin quads in the atlas, and how much larger each should become: so that a
    millimetre of the face is given the same length everywhere, and a millimetre of scalp and ears less."""
    quads = head.cage.quads["skin"]
    x = head.mean[head.coarse_of(quads)]
    surface = np.linalg.norm(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1) / 2
    diagonals = quads_uv[:, 2] - quads_uv[:, 0], quads_uv[:, 3] - quads_uv[:, 1]
    flat = np.abs(diagonals[0][:, 0] * diagonals[1][:, 1] - diagonals[0][:, 1] * diagonals[1][:, 0]) / 2
    face, ears = masks["face"][quads].mean(1), masks["ears"][quads].mean(1)
    importance = (_OFF_FACE + (1 - _OFF_FACE) * face) * (1 - (1 - _EARS) * ears)
    density = importance**2 * surface / flat
    middle = np.median(density[face > 0.5])
    return quads_uv.mean(1), np.clip(density / middle, *_MOST_CHANGE)


def _signed_area(polygons: Floats) -> float:
    """Twice the summed area of polygons (k, c, 2), negative when they run clockwise."""
    following = np.roll(polygons, -1, axis=1)
    return float((polygons[..., 0] * following[..., 1] - polygons[..., 1] * following[..., 0]).sum())


def _fitted(points: Floats, rectangle: tuple[float, float, float, float], stretch: bool) -> Floats:
    low, high = np.array(rectangle[:2]), np.array(rectangle[2:])
    first, last = points.min(0), points.max(0)
    scale = (high - low) / (last - first)
    if not stretch:
        scale = np.full(2, scale.min())
    return (low + high) / 2 + (points - (first + last) / 2) * scale
