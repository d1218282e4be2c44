"""Pictures of meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import get_args

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.colour.srgb import linear_to_srgb, srgb_to_linear
from toongeo.protocols import Camera
from toongeo.render.paint_table import PaintTable, Shading, paint_table
from toongeo.render.picture_size import picture_size
from toongeo.render.rasterize import Fragments, rasterize
from toongeo.render.studio_light import studio_light
from toongeo.render.surface import Surface

__all__ = ["render_mesh"]

_CHUNK = 2**15  # subpixels that stay in the cache


def render_mesh(
    surfaces: Surface | Sequence[Surface],
    camera: Camera,
    size: int | tuple[int, int] = 512,
    *,
    light: ArrayLike | None = None,
    background: ArrayLike = (0.94, 0.94, 0.95),
    supersample: int = 2,
    shading: Shading = "lit",
) -> NDArray[np.uint8]:
    """Picture of one or several surfaces, z-buffered and anti-aliased.

    Everything is computed in linear light. Light is evaluated at the vertices and interpolated, which a mesh
    as dense as a head does not show; textures are sampled bilinearly at every subpixel, after an area filter
    where they are minified. Both sides of a face are drawn.

    Parameters
    ----------
    surfaces : Surface or sequence of Surface
        Nearer ones hide farther ones, whatever the order.
    camera : Camera
        For instance a `ScaledOrthographicCamera`, in the pixels of the picture.
    size : int or (int, int)
        Side, or (height, width), in pixels.
    light : array_like, shape (9, 3), optional
        Radiance in spherical harmonics, *camera frame* (see `irradiance`); `studio_light` if None.
        Not used by ``shading="unlit"``.
    background : array_like, shape (3,) or (height, width, 3)
        sRGB colour, 0..1, or a uint8 picture to draw on.
    supersample : int
        Subpixels a side; 1 leaves edges jagged.
    shading : {"lit", "unlit", "clay"}
        ``"lit"``: colour times light. ``"unlit"``: the colour as it is, for textures that hold their own
        shading.
        ``"clay"``: colours are ignored and the shape is shown as a sculptor's clay.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        RGB.

    Raises
    ------
    ValueError
        If an argument has a wrong shape or value, or a vertex is not finite.

    Examples
    --------
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> from toongeo.render import Surface
    >>> triangle = Surface([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]], colours=np.eye(3))
    >>> camera = ScaledOrthographicCamera.look(size=32, extent=20.0)
    >>> picture = render_mesh(triangle, camera, 32, shading="unlit")
    >>> picture.shape, picture[30, 2].argmax(), picture[30, 29].argmax()
    ((32, 32, 3), np.int64(0), np.int64(1))
    """
    parts = (surfaces,) if isinstance(surfaces, Surface) else tuple(surfaces)
    if supersample < 1 or int(supersample) != supersample:
        raise ValueError(f"supersample: expected an integer >= 1, got {supersample!r}")
    height, width = picture_size(size, int(supersample))
    if shading not in get_args(Shading):
        raise ValueError(f"shading: expected one of {get_args(Shading)}, got {shading!r}")
    linear = _linear_background(background, height, width)
    environment = studio_light() if light is None else np.asarray(light, dtype=np.float64)
    fragments, px = _fragments(parts, camera, height, width, int(supersample))
    paint = paint_table(parts, camera, environment, shading, px)
    picture = np.empty((height, width, 3), np.uint8)
    step = max(1, _CHUNK // (width * supersample**2))
    for first in range(0, height, step):
        rows = slice(first, min(first + step, height))
        picture[rows] = _painted_rows(fragments, paint, linear[rows], rows, int(supersample))
    return picture


def _linear_background(background: ArrayLike, height: int, width: int) -> NDArray[np.float32]:
    """Background in linear light, (height, width, 3)."""
    given = np.asarray(background)
    if given.shape == (height, width, 3) and given.dtype == np.uint8:
        return srgb_to_linear(given)
    if given.shape != (3,) or given.dtype.kind not in "fiu" or not np.isfinite(given).all():
        raise ValueError(
            f"background: expected 3 numbers in 0..1 or a uint8 picture of shape ({height}, {width}, 3), "
            f"got {given.dtype} {given.shape}"
        )
    colour = srgb_to_linear(given.astype(np.float64)).astype(np.float32)
    return np.broadcast_to(colour, (height, width, 3))


def _fragments(
    parts: tuple[Surface, ...], camera: Camera, height: int, width: int, supersample: int
) -> tuple[Fragments, list[NDArray[np.float64]]]:
    """All surfaces in one z-buffer of subpixels; their faces count on. Also the subpixels (n, 2) of each."""
    points, faces, count = [], [], 0
    for part in parts:
        px = (camera.project(part.vertices) + 0.5) * supersample - 0.5
        points.append(np.column_stack([px, camera.depth(part.vertices)]))
        faces.append(part.faces + count)
        count += len(part.vertices)
    fragments = rasterize(
        np.concatenate(points or [np.zeros((0, 3))]),
        np.concatenate(faces or [np.zeros((0, 3), np.int64)]),
        height * supersample,
        width * supersample,
    )
    return fragments, [rows[:, :2] for rows in points]


def _painted_rows(
    fragments: Fragments, paint: PaintTable, background: NDArray[np.float32], rows: slice, supersample: int
) -> NDArray[np.uint8]:
    """Some rows of the picture."""
    subrows = slice(rows.start * supersample, rows.stop * supersample)
    ids = fragments.face_ids[subrows].ravel()
    covered = np.flatnonzero(ids >= 0)
    canvas = background.repeat(supersample, axis=0).repeat(supersample, axis=1)
    weights = fragments.barycentrics[subrows].reshape(-1, 3)[covered]
    canvas.reshape(-1, 3)[covered] = paint.colours(ids[covered], weights)
    if supersample > 1:
        size = background.shape[1], background.shape[0]
        canvas = np.asarray(cv2.resize(canvas, size, interpolation=cv2.INTER_AREA), np.float32)
    return (linear_to_srgb(np.clip(canvas, 0.0, 1.0)) * np.float32(255.0) + np.float32(0.5)).astype(np.uint8)
