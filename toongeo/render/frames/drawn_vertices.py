"""Vertices as they are drawn: one for each place in the atlas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Integers, Singles
from toongeo.render.frames.atlas import Atlas

__all__ = ["DrawnVertices", "drawn_vertices"]


@dataclass(frozen=True, eq=False)
class DrawnVertices:
    """A vertex that has another texel or tint in other faces is drawn as several.

    Attributes
    ----------
    origin : (k,) int
        Of which vertex each is.
    texels : (k, 2) float32
    tints : (k, 3) float32
    faces : (m, 3) int32
        Of drawn vertices.
    """

    origin: Integers
    texels: Singles
    tints: Singles
    faces: NDArray[np.int32]


def drawn_vertices(faces: Integers, atlas: Atlas, order: Integers) -> DrawnVertices:
    """Of the faces (m, 3), which lie in an atlas; they are drawn in the order of their rows (m,)."""
    corners = np.concatenate([atlas.texels, atlas.tints], axis=2).reshape(-1, 5)
    keys = np.column_stack([faces.ravel(), corners])  # float64 holds both
    sort = np.lexsort(keys.T)
    other = np.ones(len(keys), bool)
    other[1:] = (np.diff(keys[sort], axis=0) != 0).any(axis=1)
    first, of_corner = sort[other], np.empty(len(keys), np.int32)
    of_corner[sort] = np.cumsum(other) - 1
    return DrawnVertices(faces.ravel()[first], corners[first, :2], corners[first, 2:], of_corner.reshape(-1, 3)[order])
