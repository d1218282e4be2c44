"""A drawn face: clean outlines, flat colours, a cartoon's proportions, exact landmarks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from drawn_eyes import with_drawn_eyes
from renders.accessories import paint_glasses, paint_hat
from renders.canvas import Canvas, between
from renders.palette import random_palette
from renders.scene import Part, Scene
from renders.surroundings import background, paint_clothes

from figures.features import paint_brows, paint_mouth, paint_nose
from figures.layout import random_layout
from figures.outline import Line, paint_behind, paint_face, paint_hair

__all__ = ["random_figure"]


def random_figure(rng: np.random.Generator, size: int = 256, extent=(0.155, 0.195)) -> Scene:
    """A scene of kind "cartoon" that is drawn in the plane from the start, to be drawn in a style as others are.

    Its landmarks are where annotators put them on drawings: eyes and brows at what is painted, the nose at its mark,
    lips at a mouth's line where there are none, the jaw on the outline.
    """
    layout, palette = random_layout(rng, size, extent), random_palette(rng)
    picture, parts = background(rng, size), np.zeros((size, size), np.uint8)
    canvas = Canvas(picture, parts)
    dark = np.ones(3) * between(rng, 0, 40) if rng.random() < 0.75 else palette.skin * between(rng, 0.2, 0.6)
    line = Line(dark, between(rng, 0.8, 4.5) * size / 256 if rng.random() < 0.8 else 0.0)
    high = between(rng, 1.0, 1.9)  # of the skull above the eyes, in radii
    paint_behind(rng, canvas, layout, palette, line, high)
    if rng.random() < 0.8:
        neck = layout.placed([layout.points[8] + [dx, dy] for dx in (-0.4, 0.4) for dy in (0, 0.6)])
        paint_clothes(rng, canvas, neck, Part.CLOTHES)
    paint_face(rng, canvas, layout, palette, line, high)
    paint_mouth(rng, canvas, layout, palette, line)
    paint_nose(rng, canvas, layout, palette, line)
    paint_brows(rng, canvas, layout, palette, line)
    landmarks, edges = layout.placed(layout.points), np.zeros((size, size), np.float32)
    scene = Scene(np.clip(picture, 0, 255), landmarks, parts, edges, "cartoon", layout.yaw, True, True)
    scene = with_drawn_eyes(rng, scene)
    canvas = Canvas(scene.picture, parts)
    if rng.random() < 0.88:
        paint_hair(rng, canvas, layout, palette, line, high)
    if rng.random() < 0.07:
        paint_hat(rng, canvas, scene.landmarks, Part.HAT)
    if rng.random() < 0.1:
        paint_glasses(rng, canvas, scene.landmarks, Part.GLASSES)
    return replace(scene, picture=np.clip(scene.picture, 0, 255))
