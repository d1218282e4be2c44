"""Colours of a texture at the vertices."""

from __future__ import annotations

import numpy as np

from toongeo.io import SceneMesh
from toongeo.render import sample_image, uv_to_px

__all__ = ["uv_colours"]


def uv_colours(mesh: SceneMesh) -> np.ndarray:
    """Colours (t, 3), 0..255, that a textured mesh has at its uv."""
    assert mesh.texture is not None and mesh.uv is not None
    return np.asarray(sample_image(mesh.texture, uv_to_px(mesh.uv, *mesh.texture.shape[:2])))
