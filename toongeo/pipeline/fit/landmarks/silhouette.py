"""Jaw points found on the silhouette of the posed head, wherever it runs.

Constants were chosen on heads of known shape and ten pictures (``benchmarks/truth3d.py``, ``benchmarks/landmarks.py``).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toongeo.arrays import Floats
from toongeo.model.ibug68 import PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.protocols import HeadCamera

__all__ = ["silhouette_landmarks"]

_REACH_MM = 12.0  # from the contour lines: the skin on which an outline of the jaw can run
_LINES = 2  # how many lines beside its own a jaw point may move to


@dataclass(frozen=True, eq=False)
class _Band:
    """Skin around the contour lines: vertices (b,), which line is the nearest, faces (f, 3) as rows, shape."""

    vertices: NDArray[np.int64]
    line: NDArray[np.int64]
    faces: NDArray[np.int64]
    mean: Floats
    modes: Floats


def silhouette_landmarks(
    model: MorphableModel,
    coefficients: Floats,
    camera: HeadCamera,
    pixels: Floats,
    landmarks: NDArray[np.int64],
) -> NDArray[np.int64]:
    """The 68 landmark vertices with each jaw point moved to the nearest point of the silhouette that the camera sees.

    The contour lines say where a jaw point is expected; an annotator who follows the visible outline puts it anywhere
    along that. The silhouette is where the surface turns away from the viewer: a vertex that faces the camera and
    has a neighbour that does not. A point stays on its line where no silhouette is near it.

    Parameters
    ----------
    model : MorphableModel
    coefficients : (c,) float
    camera : HeadCamera
    pixels : (68, 2) float
        Observed landmarks; NaN rows stay on their lines.
    landmarks : (68,) int64
        Vertices by the lines, from `visible_landmarks`.

    References
    ----------
    A. Bas, W. Smith, T. Bolkart, S. Wuhrer, "Fitting a 3D morphable model to edges", ACCV workshops 2016.
    """
    band = _band(model)
    X = band.mean + (band.modes @ coefficients).reshape(-1, 3)
    y = camera.view(X)
    corners = y[band.faces]
    toward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    facing = np.bincount(band.faces.ravel(), np.repeat(toward, 3), len(X)) > 0
    mixed = facing[band.faces].any(axis=1) & ~facing[band.faces].all(axis=1)
    outline = np.unique(band.faces[mixed])
    outline = outline[facing[outline]]
    seen = camera.project(X[outline])
    moved = landmarks.copy()
    for k, jaw in enumerate(PARTS["jaw"]):
        near = np.abs(band.line[outline] - k) <= _LINES
        if not near.any() or np.isnan(pixels[jaw]).any():
            continue
        distance = ((seen[near] - pixels[jaw]) ** 2).sum(axis=1)
        moved[jaw] = band.vertices[outline[near][distance.argmin()]]
    return moved


@lru_cache(maxsize=4)
def _band(model: MorphableModel) -> _Band:
    line_of = np.repeat(np.arange(len(model.contour_lines)), [len(line) for line in model.contour_lines])
    distance, nearest = cKDTree(model.mean[np.concatenate(model.contour_lines)]).query(model.mean)
    near = distance < _REACH_MM
    for name in ("ears", "mouth_cavity"):
        if name in model.regions:
            near &= ~model.region(name)
    vertices = np.flatnonzero(near)
    rows = np.full(len(model.mean), -1)
    rows[vertices] = np.arange(len(vertices))
    faces = rows[model.faces]
    modes = np.concatenate([model.identity[:, vertices], model.expression[:, vertices]])
    return _Band(
        vertices=vertices,
        line=line_of[nearest[vertices]],
        faces=faces[(faces >= 0).all(axis=1)],
        mean=model.mean[vertices],
        modes=np.ascontiguousarray(modes.transpose(1, 2, 0).reshape(3 * len(vertices), -1), dtype=np.float64),
    )
