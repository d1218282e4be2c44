"""The light that pictures are rendered under unless told otherwise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.render.spherical_harmonics import sh_basis

__all__ = ["studio_light"]

# Direction towards the lamp in the camera frame (+X right, +Y up, +Z to the viewer) and its strength: what it
# adds to the shade of a surface that faces it. The lamps are neutral, so that a skin keeps its colour.
_LAMPS = (
    ((-0.55, 0.60, 0.60), 0.88),  # key, from the upper left
    ((0.85, 0.10, 0.50), 0.26),  # fill, from the right
    ((0.30, 0.55, -0.80), 0.28),  # rim, from behind and above
)
_SKY, _GROUND = 0.46, 0.16  # shade of a surface that faces straight up or down under the ambient light alone


def studio_light() -> NDArray[np.float64]:
    """Soft three-point studio light (key, fill, rim) over a hemispheric ambient light.

    Returns
    -------
    ndarray, shape (9, 3)
        Radiance in spherical harmonics, camera frame: the lamps stay with the viewer. A surface that faces
        the viewer shows about its albedo.

    Examples
    --------
    >>> from toongeo.render import irradiance
    >>> irradiance([[0.0, 0.0, 1.0]], studio_light()).shape
    (1, 3)
    """
    light = np.zeros(9)
    for towards, strength in _LAMPS:
        direction = np.array([towards]) / np.linalg.norm(towards)
        light += np.pi * strength * sh_basis(direction)[0]
    up = sh_basis(np.array([[0.0, 1.0, 0.0]]))[0]
    light[0] += 0.5 * (_SKY + _GROUND) / up[0]
    light[1] += 0.5 * (_SKY - _GROUND) * 1.5 / up[1]  # the lobe has A_1 = (2/3) pi
    return np.repeat(light[:, None], 3, axis=1)
