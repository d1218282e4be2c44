"""Which face covers each pixel, and where in it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Fragments", "rasterize"]

_MAX_FACES = 2**24  # ids travel as float32 colours, exact up to here
_MAX_REACH = 2.0**20  # px; beyond this the float32 edge functions of OpenCV lose the pixel grid
_GROWTH = 1e-5  # a pixel centre this near to an edge (in barycentrics) belongs to both sides, so no cracks open
_NEAREST, _FARTHEST = 0.99, 0.01


@dataclass(frozen=True, eq=False)
class Fragments:
    """What `rasterize` found at every pixel.

    Attributes
    ----------
    face_ids : ndarray of int32, shape (height, width)
        Row of the face that is nearest at the pixel centre, -1 where there is none.
    barycentrics : ndarray of float32, shape (height, width, 3)
        Weights of that face's three corners, >= 0 with sum 1; all 0 where there is no face.
    """

    face_ids: NDArray[np.int32]
    barycentrics: NDArray[np.float32]

    def __post_init__(self) -> None:
        if self.face_ids.ndim != 2 or self.barycentrics.shape != (*self.face_ids.shape, 3):
            raise ValueError(
                "barycentrics: expected shape (height, width, 3) to go with face_ids (height, width), got "
                f"{self.barycentrics.shape} and {self.face_ids.shape}"
            )
        for name in ("face_ids", "barycentrics"):
            array = getattr(self, name).view()
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def mask(self) -> NDArray[np.bool_]:
        """(height, width) bool, True where a face covers the pixel centre."""
        return self.face_ids >= 0


def rasterize(
    points_px: ArrayLike, F: ArrayLike, height: int, width: int, *, cull_back: bool = False
) -> Fragments:
    """Nearest face and barycentric coordinates at every pixel centre.

    Coverage and the z-buffer are those of OpenCV's software rasterizer (float32; a pixel centre within
    about 1e-4 px of an edge may fall on either side), barycentrics are computed in float64 from the points
    themselves. Triangles may lie partly or wholly outside the image; those without area are skipped.
    Pixel centres are integers. An atlas is rasterized by the same function: `uv_to_px` gives its points.

    Parameters
    ----------
    points_px : array_like, shape (n, 2) or (n, 3)
        x (right) and y (down) in pixels; the third column is the depth, *larger is nearer*, in any unit
        (`ScaledOrthographicCamera.depth`). Without it all lie at one depth.
    F : array_like of int, shape (m, 3)
        Faces. At equal depth the lower row wins.
    height, width : int
        Size of the image in pixels.
    cull_back : bool
        Leave out faces whose corners run clockwise as seen in the image.

    Returns
    -------
    Fragments

    Raises
    ------
    ValueError
        If a shape or index is wrong, a point that a face uses is not finite or lies more than 2**20 px away,
        there are more than 2**24 faces, or the size is not positive.

    Examples
    --------
    >>> fragments = rasterize([[0, 0], [2, 0], [0, 2]], [[0, 1, 2]], 3, 4)
    >>> fragments.face_ids
    array([[ 0,  0,  0, -1],
           [ 0,  0, -1, -1],
           [ 0, -1, -1, -1]], dtype=int32)
    >>> fragments.barycentrics[0, 1]
    array([0.5, 0.5, 0. ], dtype=float32)
    """
    points, faces = _checked(points_px, F, height, width)
    corners = points[faces]
    face_ids = _face_ids(corners, height, width, cull_back)
    covered = np.flatnonzero(face_ids >= 0)
    barycentrics = np.zeros((height * width, 3), np.float32)
    barycentrics[covered] = _barycentrics(corners, face_ids.ravel()[covered], covered, width)
    return Fragments(face_ids, barycentrics.reshape(height, width, 3))


def _checked(
    points_px: ArrayLike, F: ArrayLike, height: int, width: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """(n, 3) points, with a depth, and faces; OpenCV itself checks neither indices nor finiteness."""
    points, faces = np.asarray(points_px, dtype=np.float64), np.asarray(F)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError(f"points_px: expected shape (n, 2) or (n, 3), got {points.shape}")
    if faces.size == 0:
        faces = np.zeros((0, 3), np.int64)
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
        raise ValueError(f"F: expected integers of shape (m, 3), got {faces.dtype} of shape {faces.shape}")
    if len(faces) > _MAX_FACES:
        raise ValueError(f"F: expected at most {_MAX_FACES} faces, got {len(faces)}")
    if height < 1 or width < 1:
        raise ValueError(f"height, width: expected a positive size in px, got {height} x {width}")
    if len(faces) and (faces.min() < 0 or faces.max() >= len(points)):
        raise ValueError(
            f"F: expected indices in [0, {len(points)}), got {faces.min()} to {faces.max()}"
        )
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    # written so that NaN fails too
    if not (np.abs(points[:, :2]) <= _MAX_REACH).all() or not np.isfinite(points[:, 2]).all():
        used = points[np.unique(faces)]
        if not (np.abs(used[:, :2]) <= _MAX_REACH).all() or not np.isfinite(used[:, 2]).all():
            raise ValueError("points_px: expected finite points within 2**20 px of the image, got others")
    return points, faces


def _face_ids(
    corners: NDArray[np.float64], height: int, width: int, cull_back: bool
) -> NDArray[np.int32]:
    """Face id buffer: FLAT shading gives a face the colour of its first vertex, which here is its id.

    OpenCV knows only a perspective camera. At fovY = pi/2, near 1, far 2, a point at the distance
    d = 2 / (2 - t) gets the buffer depth t, so X = x_ndc d w/h, Y = y_ndc d, Z = -d undoes the perspective and
    keeps the depth linear.
    """
    colours = np.full((height, width, 3), -1.0, np.float32)
    if len(corners) == 0:
        return colours[:, :, 0].astype(np.int32)
    middle = corners.mean(axis=1, keepdims=True)
    grown = corners + (corners - middle) * _GROWTH
    depth = grown[..., 2]
    lowest, highest = depth.min(), depth.max()
    nearness = (depth - lowest) * ((_NEAREST - _FARTHEST) / ((highest - lowest) or 1.0))
    d = 2.0 / (1.0 + _FARTHEST + nearness)
    space = np.empty((len(corners), 3, 3), np.float32)
    space[..., 0] = ((grown[..., 0] + 0.5) * (2.0 / width) - 1.0) * d * (width / height)
    space[..., 1] = (1.0 - (grown[..., 1] + 0.5) * (2.0 / height)) * d
    space[..., 2] = -d
    ids = np.repeat(np.arange(len(corners), dtype=np.float32), 9).reshape(-1, 3)
    indices = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    settings = cv2.TriangleRasterizeSettings()
    settings.setShadingType(cv2.RASTERIZE_SHADING_FLAT)
    settings.setCullingMode(cv2.RASTERIZE_CULLING_CW if cull_back else cv2.RASTERIZE_CULLING_NONE)
    cv2.triangleRasterizeColor(
        space.reshape(-1, 3), indices, ids, colours, np.eye(4), np.pi / 2.0, 1.0, 2.0, settings
    )
    return colours[:, :, 0].astype(np.int32)


def _barycentrics(
    corners: NDArray[np.float64], ids: NDArray[np.int32], covered: NDArray[np.int64], width: int
) -> NDArray[np.float32]:
    """Barycentrics (k, 3) of the flat pixels ``covered`` in their faces ``ids``."""
    a = corners[:, 0, :2]
    (ux, uy), (vx, vy) = (corners[:, 1, :2] - a).T, (corners[:, 2, :2] - a).T
    twice_area = ux * vy - uy * vx
    inverse = 1.0 / np.where(twice_area == 0.0, np.inf, twice_area)  # never visible
    # weight_k = gx x + gy y + g0 is affine in the pixel: six numbers a face
    gx1, gy1, gx2, gy2 = vy * inverse, -vx * inverse, -uy * inverse, ux * inverse
    g01, g02 = -(gx1 * a[:, 0] + gy1 * a[:, 1]), -(gx2 * a[:, 0] + gy2 * a[:, 1])
    y, x = np.divmod(covered, width)
    weights = np.empty((len(ids), 3))
    weights[:, 1] = gx1[ids] * x + gy1[ids] * y + g01[ids]
    weights[:, 2] = gx2[ids] * x + gy2[ids] * y + g02[ids]
    weights[:, 0] = 1.0 - weights[:, 1] - weights[:, 2]
    outside = np.flatnonzero(weights.min(axis=1) < 0.0)  # by a rounding error of the coverage
    clipped = np.maximum(weights[outside], 0.0)
    weights[outside] = clipped / clipped.sum(axis=1, keepdims=True)
    return weights.astype(np.float32)
