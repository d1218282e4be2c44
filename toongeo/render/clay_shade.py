"""The look of a sculptor's clay."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.colour.srgb import srgb_to_linear
from toongeo.render.spherical_harmonics import irradiance

__all__ = ["clay_shade"]

_ALBEDO = srgb_to_linear(np.array([0.80, 0.74, 0.69]))  # warm grey
_HOLLOW, _RIDGE = 0.9, 0.35  # how much hollows darken and ridges brighten
_REACH = 0.02  # of the bounding box diagonal: the radius of curvature that counts as a hollow
_GLOSS, _SHARPNESS = 0.10, 18.0  # a broad sheen
_LAMP = np.array([-0.45, 0.65, 0.62]) / np.linalg.norm([-0.45, 0.65, 0.62])


def clay_shade(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int64],
    normals: NDArray[np.float64],
    light: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Linear light (n, 3) of clay: Lambert, a broad sheen, hollows darker and ridges brighter.

    All in the camera frame.
    """
    relief = _relief(vertices, faces, normals)
    diffuse = np.maximum(irradiance(normals, light) / np.pi, 0.0) * _ALBEDO
    half = _LAMP + np.array([0.0, 0.0, 1.0])  # between the lamp and the viewer
    sheen = _GLOSS * np.maximum(normals @ (half / np.linalg.norm(half)), 0.0) ** _SHARPNESS
    return (diffuse + sheen[:, None]) * relief[:, None]


def _relief(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], normals: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Factor (n,) of the light: below 1 in hollows, above on ridges, by curvature times size."""
    tail, tip = faces.ravel(), faces[:, [1, 2, 0]].ravel()  # both ways but for a boundary
    edges = vertices[tip] - vertices[tail]
    count = np.maximum(np.bincount(tail, minlength=len(vertices)), 1)
    rise = np.bincount(tail, (edges * normals[tail]).sum(axis=1), len(vertices)) / count
    squared = np.bincount(tail, (edges * edges).sum(axis=1), len(vertices)) / count
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    bend = _REACH * size * rise / np.where(squared > 0.0, squared, np.inf)
    bend = 0.5 * (bend + np.bincount(tail, bend[tip], len(vertices)) / count)  # one step of smoothing
    return 1.0 - _HOLLOW * np.tanh(np.maximum(bend, 0.0)) + _RIDGE * np.tanh(np.maximum(-bend, 0.0))
