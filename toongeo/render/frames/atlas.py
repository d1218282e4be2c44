"""All textures and colours of a scene in one picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats, Mask, Singles
from toongeo.render.paint_table import PaintTable

__all__ = ["Atlas", "atlas_of"]

_MARGIN = 4  # texels about each picture: where one place ends and another begins, two of them are seen as an edge
_WIDTH = 2**14  # px; OpenCV samples pictures of less than 2^15
_PATCHES = 64  # colours that get a patch each; a mesh that has more is painted from vertex to vertex


@dataclass(frozen=True, eq=False)
class Atlas:
    """Where the colours of a scene lie.

    Attributes
    ----------
    picture : (H, W, 3) float32
        Linear.
    texels : (m, 3, 2) float32
        Of the corners of the faces.
    tints : (m, 3, 3) float32
        Colours at the corners, that multiply those of the picture.
    ground : (2,) float32
        Texel of the background.
    """

    picture: Singles
    texels: Singles
    tints: Singles
    ground: Singles


def atlas_of(table: PaintTable, textures: Sequence[Singles], background: Floats) -> Atlas:
    """Atlas of the faces of a table, with the given pictures for its textures, and of a linear background (3,)."""
    texels, tints = np.zeros((len(table.texture_of), 3, 2), np.float32), table.corners[:, :, -3:].copy()
    one_colour = _of_one_colour(table)
    patches, which = np.unique(tints[one_colour, 0], axis=0, return_inverse=True)
    if len(patches) > _PATCHES:
        one_colour[:], patches, which = False, patches[:0], which[:0]
    tints[one_colour] = 1.0
    white = np.ones(3, np.float32)
    plain = [np.asarray(colour, np.float32).reshape(1, 1, 3) for colour in (background, white, *patches)]
    picture, corners = _side_by_side([*plain, *textures])
    texels[table.texture_of < 0] = corners[1]
    texels[one_colour] = corners[2:][which.ravel()][:, None]
    for index, texture in enumerate(textures):
        mine = np.flatnonzero(table.texture_of == index)
        inside = np.clip(table.corners[mine, :, :2], -1.0, np.array(texture.shape[1::-1]))
        texels[mine] = inside + corners[len(plain) + index]
    return Atlas(picture, texels, tints, corners[0])


def _of_one_colour(table: PaintTable) -> Mask:
    """Faces (m,) without a texture, whose corners have the same colour."""
    colours = table.corners[:, :, -3:]
    return np.asarray((table.texture_of < 0) & (colours == colours[:, :1]).all(axis=(1, 2)))


def _side_by_side(pictures: Sequence[Singles]) -> tuple[Singles, Singles]:
    """One picture of many, each with a margin of its own pixels, and the upper left corners (k, 2) of them in it."""
    corners: list[tuple[int, int]] = []
    x = y = shelf = widest = 0
    for picture in pictures:
        height, width = (side + 2 * _MARGIN for side in picture.shape[:2])
        if x and x + width > _WIDTH:
            x, y, shelf = 0, y + shelf, 0
        corners.append((x, y))
        x, shelf, widest = x + width, max(shelf, height), max(widest, x + width)
    whole: NDArray[np.float32] = np.zeros((y + shelf, widest, 3), np.float32)
    for picture, (x, y) in zip(pictures, corners, strict=True):
        framed = np.pad(picture, ((_MARGIN, _MARGIN), (_MARGIN, _MARGIN), (0, 0)), mode="edge")
        whole[y : y + framed.shape[0], x : x + framed.shape[1]] = framed
    return whole, np.array(corners, np.float32) + np.float32(_MARGIN)
