"""Pictures of the same surfaces again and again, as they move."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats, Integers, Mask, Singles
from toongeo.colour.srgb import srgb_to_linear
from toongeo.protocols import Camera
from toongeo.render.frames.atlas import atlas_of
from toongeo.render.frames.drawn_vertices import drawn_vertices
from toongeo.render.frames.edge_pixels import edge_pixels, faces_near
from toongeo.render.frames.paint import encoded, planes_on, shaded
from toongeo.render.frames.vertex_light import VertexLight
from toongeo.render.paint_table import PaintTable, minification, paint_table
from toongeo.render.raster.vertex_shader import NOTHING, VertexShader
from toongeo.render.studio_light import studio_light
from toongeo.render.surface import Surface

__all__ = ["FrameRenderer"]

_TILE = 32  # px: of 4 to 32, the quickest by a little
_CHUNK = 2**14  # pixels of a row that OpenCV samples: fewer than 2^15


class FrameRenderer:
    """Renders frames of a film: as :func:`render_mesh` does with light, five times as fast.

    What does not change from frame to frame is prepared once: all textures in one picture, in linear light and filtered
    for the size in which they are seen, and where in it each triangle lies. OpenCV draws these places and the light of
    the vertices, and the picture is looked up once for all pixels. Only where one surface ends and another begins is it
    supersampled (2 x 2); inside a surface one sample of the filtered texture is enough.

    Parameters
    ----------
    surfaces : sequence of Surface
        As they are at rest; normals are computed anew for each frame.
    camera : Camera
        In the pixels of the pictures.
    size : int
        Side of the pictures, px.
    light : array_like, shape (9, 3), optional
        As of :func:`render_mesh`; None: ``studio_light``.
    background : array_like, shape (3,)
        sRGB colour, 0..1.
    cull_back : bool
        Whether surfaces are seen from outside only, which is half the work.

    Examples
    --------
    >>> from toongeo.render import FrameRenderer, ScaledOrthographicCamera, Surface
    >>> triangle = Surface([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]], colours=np.eye(3))
    >>> renderer = FrameRenderer([triangle], ScaledOrthographicCamera.look(size=32, extent=20.0), 32)
    >>> here, there = (renderer.frame([triangle.vertices + [x, 0, 0]]) for x in (0.0, 5.0))
    >>> here.shape, bool((here[:, :24] == there[:, 8:])[20].all())
    ((32, 32, 3), True)
    """

    def __init__(
        self,
        surfaces: Sequence[Surface],
        camera: Camera,
        size: int,
        *,
        light: ArrayLike | None = None,
        background: ArrayLike = (0.94, 0.94, 0.95),
        cull_back: bool = True,
    ) -> None:
        if size < 1:
            raise ValueError(f"size: expected a positive number of px, got {size}")
        self._camera, self._size, self._cull = camera, size, cull_back
        light = studio_light() if light is None else np.asarray(light, np.float64)
        self._rest = [part.vertices for part in surfaces]
        starts = np.cumsum([0, *(len(part.vertices) for part in surfaces)]).tolist()
        faces = np.concatenate([part.faces + start for part, start in zip(surfaces, starts, strict=False)])
        px = [camera.project(part.vertices) for part in surfaces]
        table = paint_table(tuple(surfaces), camera, light, "unlit", px)
        ground = srgb_to_linear(np.asarray(background, np.float64))
        atlas = atlas_of(table, _filtered(table, surfaces, px), ground)
        self._drawn = drawn_vertices(faces, atlas, _by_tile(np.concatenate(px), faces))
        self._atlas = atlas.picture
        grey = bool((self._drawn.tints == 1.0).all()) and not np.ptp(light, axis=1).any()
        self._light = VertexLight(faces, starts[-1], light[:, :1] if grey else light)
        self._ground = np.array([*atlas.ground, *([1.0] if grey else [1.0, 1.0, 1.0, 0.0])], np.float32)
        self._px_per_mm = _px_per_mm(camera, np.concatenate(self._rest))

    @property
    def rest(self) -> list[Floats]:
        """Vertices (n, 3) of each surface at rest, as they were given."""
        return list(self._rest)

    def frame(self, vertices: Sequence[NDArray[np.floating]]) -> NDArray[np.uint8]:
        """Picture (size, size, 3) RGB.

        Parameters
        ----------
        vertices : sequence of (n, 3)
            Of each surface, in the model frame.

        Raises
        ------
        ValueError
            If there are other numbers of vertices than at rest, or one is not finite.
        """
        counts = [len(points) for points in self._rest]
        if [len(rows) for rows in vertices] != counts:
            raise ValueError(f"vertices: expected {counts} of the surfaces, got {[len(rows) for rows in vertices]}")
        points = np.concatenate(vertices).astype(np.float64)
        if not np.isfinite(points).all():
            raise ValueError("vertices: expected finite numbers, got others")
        seen = np.column_stack([self._camera.project(points), self._camera.depth(points)])
        px = seen.take(self._drawn.origin, axis=0)
        faces = self._facing(px)
        shader = VertexShader(px, self._attributes(points), self._size)
        values, distance = shader.draw(faces)
        planes = planes_on(self._ground, values, distance == NOTHING)
        picture = encoded(shaded(self._atlas, planes))
        edges = edge_pixels(planes[0], planes[1], distance, float(1 / (self._px_per_mm * shader.depth_unit)))
        if edges.any():
            picture[edges] = self._smooth(shader, px, faces, edges)
        return picture

    def _facing(self, px: Floats) -> NDArray[np.int32]:
        """Faces (k, 3) that are seen from their front, or at all."""
        x, y = px[:, :2].T.astype(np.float32)
        a, b, c = self._drawn.faces.T
        ax, ay = x.take(a), y.take(a)
        area = (x.take(b) - ax) * (y.take(c) - ay) - (y.take(b) - ay) * (x.take(c) - ax)
        return self._drawn.faces.take(np.flatnonzero(area < 0 if self._cull else area), axis=0)

    def _attributes(self, points: Floats) -> Singles:
        """Texel and light, one column or three, of the drawn vertices; columns are filled up to a multiple of 3."""
        drawn = self._drawn
        light = self._light.of(self._camera.view(points)).take(drawn.origin, axis=0)
        if light.shape[1] == 1:
            return np.concatenate([drawn.texels, light], axis=1)
        return np.concatenate([drawn.texels, light * drawn.tints, np.zeros_like(light[:, :1])], axis=1)

    def _smooth(self, shader: VertexShader, px: Floats, faces: NDArray[np.int32], edges: Mask) -> NDArray[np.uint8]:
        """Colours (k, 3) of the pixels ``edges``: means of 2 x 2 samples."""
        values, distance = shader.draw(faces.take(faces_near(px, faces, edges), axis=0), 2)
        y, x = np.nonzero(edges)
        first, line = 4 * self._size * y + 2 * x, 2 * self._size
        colours = []
        for start in range(0, len(first), _CHUNK):
            at = np.add.outer([0, 1, line, line + 1], first[start : start + _CHUNK])
            samples = values.reshape(-1, values.shape[2]).take(at, axis=0)
            planes = planes_on(self._ground, samples, distance.take(at) == NOTHING)
            colours.append(encoded(shaded(self._atlas, planes).sum(axis=0) / np.float32(4)))
        return np.concatenate(colours)


def _by_tile(px: Floats, faces: Integers) -> Integers:
    """Rows of the faces, those that are seen near each other one after the other: what is drawn stays in the cache."""
    x, y = np.floor(px[faces].mean(axis=1) / _TILE).T
    return np.lexsort([x, y])


def _filtered(table: PaintTable, surfaces: Sequence[Surface], px: Sequence[Floats]) -> tuple[Singles, ...]:
    """The textures as a pixel sees them, which is larger than a texel: else lines would flicker as they move.

    The mean over a square pixel, of which a Gaussian has the same variance: a twelfth of its side squared.
    """
    textures, first = list(table.textures), 0
    for part, points in zip(surfaces, px, strict=True):
        index, first = int(table.texture_of[first]) if len(part.faces) else -1, first + len(part.faces)
        if index >= 0 and textures[index] is table.textures[index]:
            texels = minification(part, points)
            side = texels / max(1, round(texels))
            blurred = cv2.GaussianBlur(table.textures[index], (0, 0), side / np.sqrt(12))
            textures[index] = np.asarray(blurred, np.float32)
    return tuple(textures)


def _px_per_mm(camera: Camera, points: Floats) -> np.float32:
    """How many pixels a millimetre is, across the points."""
    low, high = points.min(axis=0), points.max(axis=0)
    ends = np.stack([low, high])
    px, mm = np.ptp(camera.project(ends), axis=0), np.ptp(camera.view(ends)[:, :2], axis=0)
    return np.float32(np.linalg.norm(px) / max(float(np.linalg.norm(mm)), np.finfo(float).tiny))
