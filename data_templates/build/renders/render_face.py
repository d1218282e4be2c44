"""The door of the renderer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from renders.canvas import between
from renders.random_head import KINDS
from renders.scene import Part, Scene, random_scene
from renders.styles import STYLES, developed, draw_features, rendered_in_style, trace_edges
from renders.warp import random_warp, warped

__all__ = ["KINDS", "STYLES", "Part", "Render", "drawn", "random_scene", "random_style", "render_face"]

_DRAWN = ("flat", "painted", "ink", "posterized", "pencil", "outlined")
# Chance of a kind of head to be drawn in each of STYLES.
_MIX = {
    "person": (0.60, 0.14, 0.06, 0.10, 0.03, 0.02, 0.02, 0.03),
    "caricature": (0.22, 0.10, 0.20, 0.28, 0.05, 0.04, 0.06, 0.05),
    "cartoon": (0.07, 0.04, 0.45, 0.18, 0.06, 0.06, 0.06, 0.08),
}
# By kind: the chance of a 2D warp, its size as a share of the picture, and the chance that it magnifies parts.
_WARP = {"person": (0.25, 0.04, 0.15), "caricature": (0.7, 0.06, 0.75), "cartoon": (0.6, 0.05, 0.5)}


@dataclass(frozen=True, eq=False)
class Render:
    """A picture of one face.

    Attributes
    ----------
    picture : (s, s, 3) uint8 RGB
    landmarks : (68, 2) float64 px
        iBUG-68 order, integer = centre of a pixel. Brow points follow the painted brow, jaw points the outline.
    parts : (s, s) uint8
        A :class:`Part` a pixel.
    kind, style : str
        Of `KINDS` and `STYLES`.
    yaw : float
        Degrees; > 0 faces the subject's left.
    """

    picture: NDArray[np.uint8]
    landmarks: NDArray[np.float64]
    parts: NDArray[np.uint8]
    kind: str
    style: str
    yaw: float


def random_style(rng: np.random.Generator, kind: str) -> str:
    """A style that goes with a kind of head."""
    return str(rng.choice(STYLES, p=_MIX[kind]))


def render_face(
    rng: np.random.Generator, kind: str | None = None, style: str | None = None, size: int = 256, extent=(0.155, 0.195)
) -> Render:
    """A random face; the same generator state gives the same bytes.

    Parameters
    ----------
    rng
        The only source of randomness.
    kind
        ``"person"``, ``"caricature"`` or ``"cartoon"``; None draws one (45, 30 and 25 %).
    style
        One of `STYLES`; None draws one that goes with the kind.
    size
        Side of the picture in px.
    extent
        Range of the landmarks' root mean square radius as a share of the size.
    """
    kind = kind or str(rng.choice(KINDS, p=(0.45, 0.3, 0.25)))
    style = style or random_style(rng, kind)
    return drawn(rng, random_scene(rng, kind, style in ("flat", "outlined"), size, extent), style)


def drawn(rng: np.random.Generator, scene: Scene, style: str) -> Render:
    """The scene in a style; the same scene may be drawn many times."""
    size, points = len(scene.picture), scene.landmarks
    picture, parts = scene.picture.copy(), scene.parts
    by_hand = style in _DRAWN
    if (by_hand and rng.random() < 0.7) or rng.random() < 0.05:
        picture = trace_edges(rng, picture, scene.edges)
    if by_hand and not scene.lined and rng.random() < 0.65:
        draw_features(rng, picture, points)
    chance, amount, magnifying = _WARP[scene.kind]
    if rng.random() < chance:
        field = random_warp(rng, points, size, between(rng, 0, amount) * size, rng.random() < magnifying)
        points, picture, parts = warped(field, points, picture, parts)
    picture = rendered_in_style(rng, picture, style)
    if style not in ("photo", "grey") and rng.random() < 0.25:  # drawings are printed grey, too
        picture = rendered_in_style(rng, picture, "grey")
    return Render(developed(rng, picture, points), points, parts.copy(), scene.kind, style, scene.yaw)
