"""The light on a texture that was lit once already."""

from __future__ import annotations

import numpy as np

from toongeo.render import irradiance, studio_light

__all__ = ["soft_light"]


def soft_light() -> np.ndarray:
    """Half the relief of the studio light, and as bright towards the viewer."""
    light = studio_light()
    front = irradiance(np.array([[0.0, 0.0, 1.0]]), light)[0]
    light[1:] *= 0.5
    return light * (front / irradiance(np.array([[0.0, 0.0, 1.0]]), light)[0])
