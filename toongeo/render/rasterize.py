"""Which face covers each pixel, and where in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo.render.raster.affine_weights import affine_weights
from toongeo.render.raster.nearest_rows import nearest_rows
from toongeo.render.raster.reaching_a_pixel import reaching_a_pixel

__all__ = ["Fragments", "rasterize"]

_MAX_FACES = 2**24  # ids travel as float32 colours, exact up to here
_MAX_REACH = 2.0**20  # px; beyond this the float32 edge functions of OpenCV lose the pixel grid
_CHUNK = 2**15  # pixels that stay in the cache


@dataclass(frozen=True, eq=False)
class Fragments:
    """What `rasterize` found at every pixel.

    Attributes
    ----------
    face_ids : ndarray of int32, shape (height, width)
        Row of the face that is nearest at the pixel centre, -1 where there is none.
    barycentrics : ndarray of float32, shape (height, width, 3)
        Weights of that face's three corners, >= 0 with sum 1; all 0 where there is no face.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.render import Fragments
    >>> nothing = Fragments(np.full((4, 6), -1, dtype=np.int32), np.zeros((4, 6, 3), dtype=np.float32))
    >>> bool((nothing.face_ids == -1).all())
    True
    """

    face_ids: NDArray[np.int32]
    barycentrics: NDArray[np.float32]

    __repr__ = brief_repr

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
    points_px: ArrayLike,
    F: ArrayLike,
    height: int,
    width: int,
    *,
    cull_back: bool = False,
) -> Fragments:
    """Nearest face and barycentric coordinates at every pixel centre.

    Coverage and the z-buffer are those of OpenCV 5's software rasterizer (float32; a pixel centre within
    about 1e-4 px of an edge may fall on either side), or slower ones of our own where OpenCV has none; barycentrics
    are computed in float64 from the points themselves. Triangles may lie partly or wholly outside the image; those
    without area are skipped. Pixel centres are integers. An atlas is rasterized by the same function: `uv_to_px`
    gives its points.

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
    drawn = reaching_a_pixel(points, faces, height, width)
    affine, twice_area = affine_weights(points, faces[drawn])
    kept = np.flatnonzero(twice_area < 0.0 if cull_back else twice_area)
    drawn, affine = drawn[kept], affine[kept]
    rows = nearest_rows(points, faces[drawn], affine, height, width)
    barycentrics = _barycentrics(affine, rows)
    face_ids = np.append(drawn, -1).astype(np.int32)[rows]  # row -1 is the last one
    return Fragments(face_ids, barycentrics)


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
        raise ValueError(f"F: expected indices in [0, {len(points)}), got {faces.min()} to {faces.max()}")
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    # written so that NaN fails too
    if not (np.abs(points[:, :2]) <= _MAX_REACH).all() or not np.isfinite(points[:, 2]).all():
        used = points[np.unique(faces)]
        if not (np.abs(used[:, :2]) <= _MAX_REACH).all() or not np.isfinite(used[:, 2]).all():
            raise ValueError("points_px: expected finite points within 2**20 px of the image, got others")
    return points, faces


def _barycentrics(affine: NDArray[np.float64], rows: NDArray[np.integer]) -> NDArray[np.float32]:
    """Barycentrics (height, width, 3) of every pixel in the face it shows."""
    height, width = rows.shape
    flat_rows = rows.ravel()
    flat = np.zeros((height * width, 3), np.float32)
    covered = np.flatnonzero(flat_rows >= 0)
    for start in range(0, len(covered), _CHUNK):
        pixels = covered[start : start + _CHUNK]
        gx1, gy1, g01, gx2, gy2, g02 = affine.take(flat_rows[pixels], axis=0).T
        y, x = np.divmod(pixels, width)
        weights = np.empty((len(pixels), 3))
        weights[:, 1] = gx1 * x + gy1 * y + g01
        weights[:, 2] = gx2 * x + gy2 * y + g02
        weights[:, 0] = 1.0 - weights[:, 1] - weights[:, 2]
        lowest = np.minimum(np.minimum(weights[:, 0], weights[:, 1]), weights[:, 2])
        outside = np.flatnonzero(lowest < 0.0)  # by the rounding error of the coverage
        clipped = np.maximum(weights[outside], 0.0)
        weights[outside] = clipped / clipped.sum(axis=1, keepdims=True)
        flat[pixels] = weights
    return flat.reshape(height, width, 3)
