"""Shading by each harmonic of light, and its slope."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats
from toongeo.render.spherical_harmonics import sh_basis

__all__ = ["shading_basis", "shading_slope"]

_LOBE = np.repeat([1.0, 2 / 3, 1 / 4], [1, 3, 5])  # Lambert's, over pi (Ramamoorthi & Hanrahan 2001, Eq. 8)
# Factors of x, y, z; of xy, yz, xz and (x^2 - y^2) / 2; of 3 z^2 - 1: read off `sh_basis` where the others vanish.
_LINEAR = float(sh_basis([[1.0, 0.0, 0.0]])[0, 3])
_PRODUCT = 2 * float(sh_basis([[1.0, 0.0, 0.0]])[0, 8])
_AXIAL = -float(sh_basis([[1.0, 0.0, 0.0]])[0, 6])


def shading_basis(normals: Floats) -> Floats:
    """Shade (k, 9) of white surfaces with these normals (k, 3) under each harmonic of unit radiance."""
    return sh_basis(normals) * _LOBE


def shading_slope(normals: Floats, light: Floats) -> Floats:
    """Derivative (k, 3) by the normals of shading under this light (9,)."""
    x, y, z = normals.T
    _, y1, z1, x1, xy, yz, zz, xz, xx = light * _LOBE
    return np.stack(
        [
            _LINEAR * x1 + _PRODUCT * (xy * y + xz * z + xx * x),
            _LINEAR * y1 + _PRODUCT * (xy * x + yz * z - xx * y),
            _LINEAR * z1 + _PRODUCT * (yz * y + xz * x) + 6 * _AXIAL * zz * z,
        ],
        axis=1,
    )
