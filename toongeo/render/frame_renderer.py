"""Pictures of the same surfaces again and again, as they move."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats, Integers, Mask, Singles
from toongeo.colour.srgb import linear_to_srgb, srgb_to_linear
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.protocols import Camera
from toongeo.render.frames.edge_pixels import edge_pixels, faces_near
from toongeo.render.frames.face_paint import FacePaint
from toongeo.render.paint_table import PaintTable, minification, paint_table
from toongeo.render.raster.affine_weights import affine_weights
from toongeo.render.raster.nearest_rows import nearest_rows
from toongeo.render.spherical_harmonics import irradiance
from toongeo.render.studio_light import studio_light
from toongeo.render.surface import Surface

__all__ = ["FrameRenderer"]

_TILE = 32  # px: of 4 to 32, the quickest by a little
_NOWHERE = np.float32(-1e6)  # depth where nothing is
# Between black and the next colour there are 20 of these steps; elsewhere there are more.
_ENCODED = np.rint(255 * linear_to_srgb(np.arange(2**16) / (2**16 - 1))).astype(np.uint8)


class FrameRenderer:
    """Renders frames of a film: as :func:`render_mesh` does with light, three times as fast.

    What does not change from frame to frame is prepared once: textures in linear light, filtered for the size in which
    they are seen, and where in them each triangle lies. Only pixels at which one surface ends and another begins are
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
        self._light = studio_light() if light is None else np.asarray(light, np.float64)
        self._background = srgb_to_linear(np.asarray(background, np.float64)).astype(np.float32)
        self._rest = [part.vertices for part in surfaces]
        self._faces = [np.asarray(part.faces) for part in surfaces]
        counts = np.cumsum([0, *(len(part.vertices) for part in surfaces)]).tolist()
        self._parts = [slice(a, b) for a, b in zip(counts[:-1], counts[1:], strict=True)]
        self._all = np.concatenate([faces + start for faces, start in zip(self._faces, counts, strict=False)])
        px = [camera.project(part.vertices) for part in surfaces]
        table = paint_table(tuple(surfaces), camera, self._light, "unlit", px)
        self._albedo = _vertex_colours(table, self._all, counts[-1])
        order = _by_tile(np.concatenate(px), self._all)
        self._all, self._texture_of = self._all[order], table.texture_of[order]
        self._textures = _filtered(table, surfaces, px)
        self._texels = np.zeros((2, 3, len(order)), np.float32)
        if table.textures:
            self._texels[:] = table.corners[order, :, :2].transpose(2, 1, 0)
        self._px_per_mm = _px_per_mm(camera, np.concatenate([part.vertices for part in surfaces]))

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
        counts = [part.stop - part.start for part in self._parts]
        if [len(rows) for rows in vertices] != counts:
            raise ValueError(f"vertices: expected {counts} of the surfaces, got {[len(rows) for rows in vertices]}")
        points = np.concatenate(vertices).astype(np.float64)
        if not np.isfinite(points).all():
            raise ValueError("vertices: expected finite numbers, got others")
        px = np.column_stack([self._camera.project(points), self._camera.depth(points)])
        affine, twice_area = affine_weights(px, self._all)
        shown = np.flatnonzero(twice_area < 0.0 if self._cull else twice_area)
        faces, affine = self._all.take(shown, axis=0), affine.take(shown, axis=0)
        corners = np.concatenate([self._texels.take(shown, axis=2), self._lit(points).take(faces.T, axis=1)])
        paint = FacePaint.of_corners(affine, corners, self._texture_of[shown], self._textures)
        size = self._size
        canvas = np.repeat(_encoded(self._background)[:, None], size**2, axis=1)
        places = np.full((3, size**2), _NOWHERE)
        rows = nearest_rows(px, faces, affine, size, size).ravel()
        covered = np.flatnonzero(rows >= 0)
        y, x = np.divmod(covered, size)
        for some, values in paint.at(rows[covered].astype(np.intp), x.astype(np.float32), y.astype(np.float32)):
            where, shades = covered[some], _encoded(values[3:])
            for k in range(3):
                places[k, where], canvas[k, where] = values[k], shades[k]
        edges = edge_pixels(places.reshape(3, size, size))
        if edges.any():
            canvas[:, edges.ravel()] = _encoded(self._smooth(px, faces, paint, edges))
        return np.asarray(cv2.merge(tuple(canvas.reshape(3, size, size))), np.uint8)

    def _lit(self, points: Floats) -> Singles:
        """Depth in px and linear colour of each vertex (4, n)."""
        normals = vertex_normals(self._camera.view(points), self._all)
        attributes = np.empty((4, len(points)), np.float32)
        attributes[0] = self._camera.depth(points) * self._px_per_mm
        shade = np.maximum(irradiance(normals, self._light) / np.pi, 0)
        attributes[1:] = (shade.astype(np.float32) * self._albedo).T
        return attributes

    def _smooth(self, px: Floats, faces: Integers, paint: FacePaint, edges: Mask) -> Singles:
        """Linear colours (3, k) of the pixels ``edges``: means of 2 x 2 samples."""
        some = faces_near(px, faces, edges)
        finer = (px + [0.5, 0.5, 0.0]) * [2.0, 2.0, 1.0] - [0.5, 0.5, 0.0]
        affine, _ = affine_weights(finer, faces[some])
        found = nearest_rows(finer, faces[some], affine, 2 * self._size, 2 * self._size)
        y, x = np.nonzero(edges)
        rows, columns = 2 * y[:, None] + [0, 0, 1, 1], 2 * x[:, None] + [0, 1, 0, 1]
        nearest = found[rows, columns].ravel()
        covered = np.flatnonzero(nearest >= 0)
        across, along = (((at.ravel()[covered] - 0.5) / 2).astype(np.float32) for at in (columns, rows))
        samples = np.repeat(self._background[:, None], len(nearest), axis=1)
        for here, values in paint.at(some[nearest[covered]], across, along):
            samples[:, covered[here]] = values[3:]
        return samples.reshape(3, -1, 4).mean(axis=2)


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


def _vertex_colours(table: PaintTable, faces: Integers, count: int) -> Singles:
    """Linear colours (n, 3) that multiply light and texture."""
    colours = np.ones((count, 3), np.float32)
    colours[faces.ravel()] = table.corners[:, :, -3:].reshape(-1, 3)
    return colours


def _px_per_mm(camera: Camera, points: Floats) -> np.float32:
    """How many pixels a millimetre is, across the points."""
    low, high = points.min(axis=0), points.max(axis=0)
    ends = np.stack([low, high])
    px, mm = np.ptp(camera.project(ends), axis=0), np.ptp(camera.view(ends)[:, :2], axis=0)
    return np.float32(np.linalg.norm(px) / max(float(np.linalg.norm(mm)), np.finfo(float).tiny))


def _encoded(linear: Singles) -> NDArray[np.uint8]:
    """sRGB of linear light, by a table whose steps are finer than those of the result."""
    steps = np.float32(len(_ENCODED) - 1)
    return _ENCODED.take((linear * steps + np.float32(0.5)).astype(np.intp), mode="clip")
