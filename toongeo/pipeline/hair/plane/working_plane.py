"""The camera's plane with the head upright, in millimetres, and a raster of it."""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from toongeo.pipeline.align.align_face import AlignedFace

__all__ = ["CELL_MM", "WorkingPlane", "working_plane"]

CELL_MM = 1.25  # side of a cell: a third of the thinnest strand that is kept
_PAD_MM = 25.0  # of empty cells about head and hair: more than any ball that rolls over them
_MOST_PIXELS = 20_000  # of the mask, whose extent is asked

Floats = NDArray[np.floating]


@dataclass(frozen=True, eq=False)
class WorkingPlane:
    """Frame +X right, +Y up, +Z towards the viewer, mm: the camera's without its roll. Rows of the raster run up.

    Attributes
    ----------
    rotation : (3, 3) float64
        From the model frame.
    unroll : (2, 2) float64
        From the plane back to the camera frame's x and y.
    scale : float
        Pixels per mm.
    translation : (2,) float64, px
    low : (2,) float64, mm
        Centre of the cell (0, 0).
    shape : (rows, columns)
    """

    rotation: Floats
    unroll: Floats
    scale: float
    translation: Floats
    low: Floats
    shape: tuple[int, int]

    def of(self, points: Floats) -> Floats:
        """Plane coordinates (n, 3) of model-frame points (n, 3)."""
        return np.asarray(points @ self.rotation.T)

    def back(self, points: Floats) -> Floats:
        """Model-frame points (n, 3); inverse of :meth:`of`."""
        return np.asarray(points @ self.rotation)

    def px(self, xy: Floats) -> Floats:
        """Pixels (n, 2) of plane points (n, 2)."""
        return np.asarray(self.scale * (xy @ self.unroll.T) * [1, -1] + self.translation)

    def xy(self, px: Floats) -> Floats:
        """Plane points (n, 2) of pixels (n, 2); inverse of :meth:`px`."""
        return np.asarray(((px - self.translation) / self.scale * [1, -1]) @ self.unroll)

    def cells(self, xy: Floats) -> Floats:
        """Column and row (n, 2) of plane points (n, 2)."""
        return (xy - self.low) / CELL_MM

    def points(self, cells: Floats) -> Floats:
        """Plane points (n, 2) of columns and rows (n, 2)."""
        return np.asarray(cells) * CELL_MM + self.low

    def sample(self, raster: NDArray[Any], xy: Floats) -> Floats:
        """Values (n,) of a raster at plane points (n, 2), linear in between."""
        columns, rows = self.cells(xy).T
        return np.asarray(map_coordinates(raster.astype(np.float64), [rows, columns], order=1, mode="nearest"))

    def warp(self, img: NDArray[Any], cell_mm: float = CELL_MM, *, nearest: bool = False) -> NDArray[Any]:
        """A picture on the raster, or on one of other cells with the same corner; 0 beyond its border."""
        corners = self.px(np.array([self.low, self.low + [cell_mm, 0], self.low + [0, cell_mm]]))
        affine = np.column_stack([corners[1] - corners[0], corners[2] - corners[0], corners[0]])
        rows, columns = (round(n * CELL_MM / cell_mm) for n in self.shape)
        method = cv2.INTER_NEAREST if nearest else cv2.INTER_LINEAR
        return np.asarray(cv2.warpAffine(img, affine, (columns, rows), flags=method | cv2.WARP_INVERSE_MAP))


def working_plane(face: AlignedFace, mask: NDArray[np.bool_]) -> WorkingPlane:
    """The plane that holds a head and the pixels (H, W) of a mask, hair that is, with room about them."""
    camera = face.camera
    angle = np.deg2rad(camera.roll)
    unroll = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turn = np.eye(3)
    turn[:2, :2] = unroll.T
    # Any camera has these: the axes and the origin of the picture in the model frame.
    origin, along = camera.project(np.zeros((1, 3)))[0], camera.view(np.eye(3)) - camera.view(np.zeros((1, 3)))
    scale = float(np.linalg.norm(camera.jacobian(np.zeros((1, 3)))[0, 0]))
    plane = WorkingPlane(turn @ along.T, unroll, scale, origin, np.zeros(2), (1, 1))
    head = plane.of(face.vertices[face.region("skin") | face.region("neck")])[:, :2]
    rows, columns = np.nonzero(mask)
    every = max(1, len(rows) // _MOST_PIXELS)
    hair = plane.xy(np.column_stack([columns, rows])[::every].astype(np.float64))
    shown = np.vstack([head, hair])
    low, high = shown.min(0) - _PAD_MM, shown.max(0) + _PAD_MM
    columns_, rows_ = (np.ceil((high - low) / CELL_MM).astype(int) + 1).tolist()
    return WorkingPlane(plane.rotation, unroll, scale, origin, low, (rows_, columns_))
