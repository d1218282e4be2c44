"""Front and back of a mesh as depths over the plane."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import grey_dilation

from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane
from toongeo.render import interpolate, rasterize

__all__ = ["ball_offset", "depth_maps", "silhouette"]

Floats = NDArray[np.floating]
_NOWHERE = -1e6


def depth_maps(plane: WorkingPlane, X: Floats, F: NDArray[np.integer]) -> tuple[Floats, Floats]:
    """Greatest and least z (rows, columns) of a mesh in the plane's frame; -inf and +inf where there is none."""
    cells = np.column_stack([plane.cells(X[:, :2]), X[:, 2]])
    front = rasterize(cells, F, *plane.shape)
    back = rasterize(cells * [1, 1, -1], F, *plane.shape)
    return (
        np.where(front.mask, interpolate(front, F, X[:, 2]), -np.inf),
        np.where(back.mask, interpolate(back, F, X[:, 2]), np.inf),
    )


def silhouette(plane: WorkingPlane, X: Floats, F: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Cells that triangles cover, of a mesh in the plane's frame."""
    return rasterize(plane.cells(X[:, :2]), F, *plane.shape).mask


def ball_offset(front: Floats, radius_mm: float) -> Floats:
    """Upper envelope of balls about every point of a depth map whose empty cells are -inf."""
    reach = int(np.ceil(radius_mm / CELL_MM))
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1] * CELL_MM
    square = radius_mm**2 - x * x - y * y
    ball = np.where(square >= 0, np.sqrt(np.maximum(square, 0)), _NOWHERE)
    low = np.where(np.isfinite(front), front, _NOWHERE)
    raised = grey_dilation(low, structure=ball)
    return np.where(raised < _NOWHERE / 2, -np.inf, raised)
