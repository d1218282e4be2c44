"""A picture warped by its landmarks alone: the plain baseline of expression editing."""

import cv2
import numpy as np
from scipy.interpolate import RBFInterpolator

from toongeo.geometry.one_thread import one_thread
from toongeo.io import check_image

__all__ = ["thin_plate_warp"]

_GRID = 8  # px: the smooth warp is evaluated at every so many pixels


def thin_plate_warp(img: np.ndarray, source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Picture in which points are moved, by the thin-plate spline through them; corners and border middles stay.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    source, target : (k, 2) float, px
        Where points are, and where they shall be.

    Returns
    -------
    (H, W, 3) uint8 RGB

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the points are not two finite sets of one shape (k, 2).

    Examples
    --------
    >>> img = np.zeros((40, 40, 3), np.uint8)
    >>> img[19:22, 19:22] = 255
    >>> moved = thin_plate_warp(img, np.array([[20.0, 20.0]]), np.array([[23.0, 20.0]]))
    >>> int(moved[20, 23, 0]), int(moved[20, 20, 0])
    (255, 0)
    """
    check_image(img)
    if source.ndim != 2 or source.shape[1] != 2 or target.shape != source.shape:
        raise ValueError(f"target: expected points (k, 2) like the source, got {target.shape} and {source.shape}")
    if not (np.isfinite(source).all() and np.isfinite(target).all()):
        raise ValueError("source, target: expected finite pixels, got NaN or infinity")
    height, width = img.shape[:2]
    frame = np.array([[x, y] for x in (0, width // 2, width - 1) for y in (0, height // 2, height - 1)], float)
    frame = frame[np.abs(frame - [width // 2, height // 2]).max(1) > 1]
    knots, first = np.unique(np.vstack([target, frame]), axis=0, return_index=True)
    back = np.vstack([source, frame])[first] - knots
    columns, rows = np.arange(0, width + _GRID, _GRID), np.arange(0, height + _GRID, _GRID)
    grid = np.stack(np.meshgrid(columns, rows), axis=2).reshape(-1, 2).astype(float)
    with one_thread():
        coarse = RBFInterpolator(knots, back, kernel="thin_plate_spline")(grid)
    coarse = coarse.reshape(len(rows), len(columns), 2).astype(np.float32)
    x, y = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
    motion = [cv2.remap(coarse[..., k].copy(), x / _GRID, y / _GRID, cv2.INTER_LINEAR) for k in range(2)]
    return np.asarray(cv2.remap(img, x + motion[0], y + motion[1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE))
