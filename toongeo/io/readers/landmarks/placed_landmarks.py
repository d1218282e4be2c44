"""Points as a file has them into 68 pixels."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.landmarks.frontal_layout import frontal_layout, frontal_pose
from toongeo.io.landmarks.landmark_schemes import SCHEMES, ibug_points, scheme_of

__all__ = ["PictureSize", "PlacedLandmarks", "placed_landmarks"]

_Floats = NDArray[np.float64]
PictureSize = tuple[int, int] | NDArray[np.uint8]

# Shares of a picture lie in 0..1, and a little beyond for faces at its edge; a face in pixels is larger.
_LARGEST_SHARE = 2.0
# How much better a face with x and y exchanged must be, as in check_landmarks.
_HANDEDNESS_MARGIN = 0.1


@dataclass(frozen=True, eq=False)
class PlacedLandmarks:
    """The 68 points (68, 2) px, the scheme they came from, and what was guessed, for people."""

    points: _Floats
    scheme: str
    notes: str


def placed_landmarks(
    points: _Floats, path: Path, *, scheme: str, size: PictureSize | None, axes_doubtful: bool
) -> PlacedLandmarks:
    """The 68 landmarks out of one face of a file: see `read_landmark_file` for the arguments.

    Raises
    ------
    ValueError
        If no scheme has this number of points, or they are shares of a picture of unknown size.
    """
    points, notes = _pixels(points, size, path)
    name = f"landmarks in {path}"
    used = scheme_of(points, name) if scheme == "auto" else scheme
    landmarks = ibug_points(points, used, name)
    if axes_doubtful and _columns_exchanged(landmarks):
        landmarks = landmarks[:, ::-1].copy()
        notes += "; as (x, y), in which they form a face, and not as (y, x)"
    return PlacedLandmarks(landmarks, used, notes)


def _pixels(points: _Floats, size: PictureSize | None, path: Path) -> tuple[_Floats, str]:
    """Points in pixels, and a note if they were shares of the picture."""
    finite = points[np.isfinite(points).all(axis=1)]
    if not len(finite) or np.abs(finite).max() > _LARGEST_SHARE:
        return points, ""
    if size is None:
        if len(points) in SCHEMES["mediapipe478"]:
            raise ValueError(f"size: landmarks in {path} are shares of the picture; expected its (width, height)")
        return points, ""
    width, height = _width_and_height(size)
    return points * [width, height] - 0.5, f"; shares of a picture of {width} x {height} px"


def _width_and_height(size: PictureSize) -> tuple[int, int]:
    if isinstance(size, np.ndarray) and size.ndim in (2, 3):
        size = (size.shape[1], size.shape[0])
    try:
        width, height = (int(n) for n in size)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"size: expected (width, height) px or a picture, got {size!r}") from None
    if min(width, height) < 1:
        raise ValueError(f"size: expected (width, height) > 0 px, got {size!r}")
    return width, height


def _columns_exchanged(points: _Floats) -> bool:
    usable = np.isfinite(points[:, 0])
    if not np.ptp(points[usable], axis=0).any():
        return False
    _, misfit, mirrored = frontal_pose(points[usable], frontal_layout().points[usable])
    return mirrored < misfit - _HANDEDNESS_MARGIN
