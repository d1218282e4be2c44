"""What a texture shows at the vertices."""

import numpy as np

from toongeo.arrays import Singles
from toongeo.model import MorphableModel, atlas_coordinates
from toongeo.render import sample_image, uv_to_px

__all__ = ["vertex_colours"]


def vertex_colours(model: MorphableModel, texture: np.ndarray) -> Singles:
    """Colours (n, 3) float32, 0-255, that a texture (size, size, 3) has at the vertices."""
    atlas = atlas_coordinates(model)
    colours = np.zeros((len(model.mean), 3), np.float32)
    at_corners = sample_image(texture, uv_to_px(atlas.uv, len(texture), len(texture)))
    colours[model.faces] = at_corners[atlas.uv_faces]
    return colours
