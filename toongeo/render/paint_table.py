"""What colour each face of a scene has, ready to be looked up at the pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.colour.srgb import srgb_to_linear
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.protocols import Camera
from toongeo.render.clay_shade import clay_shade
from toongeo.render.interpolate import blend_corners
from toongeo.render.sample_image import sample_image
from toongeo.render.spherical_harmonics import irradiance
from toongeo.render.surface import Surface
from toongeo.render.uv_to_px import uv_to_px

__all__ = ["PaintTable", "Shading", "minification", "paint_table"]

Shading = Literal["lit", "unlit", "clay"]

_UNPAINTED = 0.7  # sRGB grey of a surface without colours or texture
_SAMPLED_FACES = 4096  # whose median tells how much a texture is minified


@dataclass(frozen=True, eq=False)
class PaintTable:
    """Paint of all faces of a scene, in linear light.

    Attributes
    ----------
    corners : ndarray of float32, shape (m, 3, 5), or (m, 3, 3) without textures
        At each corner of each face: texel (x, y) if there is any texture, then the colour; the texture
        multiplies it.
    texture_of : ndarray of int, shape (m,)
        Index into ``textures``, -1 for a face without one.
    textures : tuple of ndarray of float32, shape (H, W, 3)
    """

    corners: NDArray[np.float32]
    texture_of: NDArray[np.int64]
    textures: tuple[NDArray[np.float32], ...]

    def colours(self, ids: NDArray[np.integer], weights: NDArray[np.float32]) -> NDArray[np.float32]:
        """Linear colours (k, 3) in the faces ``ids`` (k,) at the barycentrics ``weights`` (k, 3)."""
        if not self.textures:
            return blend_corners(self.corners, ids, weights)
        values = blend_corners(self.corners, ids, weights)
        colours = values[:, 2:]
        textures = self.texture_of.take(ids)
        for index, texture in enumerate(self.textures):
            mine = np.flatnonzero(textures == index)
            colours[mine] *= sample_image(texture, values[mine, :2])
        return colours


def paint_table(
    parts: tuple[Surface, ...],
    camera: Camera,
    light: NDArray[np.float64],
    shading: Shading,
    px: list[NDArray[np.float64]],
) -> PaintTable:
    """Paint of the surfaces, whose vertices lie at ``px`` ((n, 2) each, subpixels); faces count on."""
    corners = np.zeros((sum(len(part.faces) for part in parts), 3, 5), np.float32)
    texture_of = np.full(len(corners), -1)
    textures: dict[tuple[int, int], NDArray[np.float32]] = {}
    stop = 0
    for part, points in zip(parts, px, strict=True):
        start, stop = stop, stop + len(part.faces)
        shade = _shade(part, camera, light, shading)
        if shading != "clay" and part.texture is None:
            grey = np.full((1, 3), _UNPAINTED)
            shade = shade * srgb_to_linear(grey if part.colours is None else part.colours)
        corners[start:stop, :, 2:] = shade.astype(np.float32).take(part.faces, axis=0)
        if shading == "clay" or part.texture is None or part.uv is None or part.uv_faces is None:
            continue
        key = id(part.texture), max(1, round(minification(part, points)))
        if key not in textures:
            textures[key] = _reduced(part.texture, key[1])
        texture_of[start:stop] = list(textures).index(key)
        texels = uv_to_px(part.uv, *textures[key].shape[:2]).astype(np.float32)
        corners[start:stop, :, :2] = texels.take(part.uv_faces, axis=0)
    if not textures:
        corners = np.ascontiguousarray(corners[:, :, 2:])
    return PaintTable(corners, texture_of, tuple(textures.values()))


def _shade(part: Surface, camera: Camera, light: NDArray[np.float64], shading: Shading) -> NDArray[Any]:
    """Linear light (n, 3) that the vertices send out at albedo 1; for clay, the clay's own."""
    if shading == "unlit":
        return np.ones((len(part.vertices), 3))
    seen = camera.view(part.vertices)
    if part.normals is None:
        normals = vertex_normals(seen, part.faces)
    else:
        normals = camera.view(part.normals) - camera.view(np.zeros((1, 3)))
    if shading == "clay":
        return clay_shade(seen, part.faces, normals, light)
    return np.maximum(irradiance(normals, light) / np.pi, 0.0)


def minification(part: Surface, points: NDArray[np.float64]) -> float:
    """Texels a subpixel, along a side: the median over the area of what faces the viewer; 1 if nothing does."""
    assert part.texture is not None and part.uv is not None and part.uv_faces is not None
    some = slice(None, None, 1 + len(part.faces) // _SAMPLED_FACES)
    texels = np.abs(_areas(uv_to_px(part.uv, *part.texture.shape[:2])[part.uv_faces[some]]))
    px = -_areas(points[part.faces[some]])  # y is down
    texels, px = texels[px > 0.0], px[px > 0.0]
    if len(px) == 0:
        return 1.0
    ratio, order = texels / px, np.argsort(texels / px, kind="stable")
    middle = np.searchsorted(np.cumsum(px[order]), 0.5 * px.sum())
    return float(np.sqrt(ratio[order[min(middle, len(order) - 1)]]))


def _areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Twice the signed areas (m,) of triangles (m, 3, 2)."""
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return ux * vy - uy * vx


def _reduced(texture: NDArray[np.uint8], reduction: int) -> NDArray[np.float32]:
    """Texture in linear light, each side ``reduction`` times shorter by an area average."""
    linear = srgb_to_linear(texture)
    if reduction == 1:
        return linear
    height, width = texture.shape[:2]
    smaller = (max(1, width // reduction), max(1, height // reduction))
    return np.asarray(cv2.resize(linear, smaller, interpolation=cv2.INTER_AREA), np.float32)
