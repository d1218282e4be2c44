"""Pictures of the general renderer, as far as they say which pixels are hair."""

from __future__ import annotations

import numpy as np
from noise import Rng
from random_picture import HAIR, HAT, Picture, cropped
from renders import Part, render_face

__all__ = ["rendered_face"]

_LEAST = 0.01  # of the pixels; with less hair a painted scalp may be labelled skin


def rendered_face(rng: Rng) -> Picture:
    """A hairy head, with air around it mostly."""
    while True:
        size = int(rng.integers(300, 440))
        render = render_face(rng, size=size, extent=(0.09, 0.15))
        if (render.parts == Part.HAIR).mean() > _LEAST:
            break
    labels = np.zeros(render.parts.shape, np.uint8)
    labels[render.parts == Part.HAIR], labels[render.parts == Part.HAT] = HAIR, HAT
    unit = np.linalg.norm(render.landmarks[36] - render.landmarks[45])
    landmarks = render.landmarks + rng.normal(0, 0.012 * unit, render.landmarks.shape)
    return cropped(rng, Picture(render.picture, labels, landmarks))
