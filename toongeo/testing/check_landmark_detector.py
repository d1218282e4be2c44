"""Whether something is a `LandmarkDetector`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.protocols import LandmarkDetection, LandmarkDetector
from toongeo.testing.example import example, require, unchanged

__all__ = ["check_landmark_detector"]

_INSIDE = 0.5  # of the picture's size: how far outside of it a point may be


def check_landmark_detector(detector: LandmarkDetector, img: NDArray[np.uint8] | None = None) -> None:
    """Call a detector on a picture, and on one without a face.

    Parameters
    ----------
    detector : LandmarkDetector
    img : (H, W, 3) uint8 RGB, optional
        In which it finds a face; a bundled drawing unless given.

    Raises
    ------
    AssertionError
        If it finds no face there, finds one in a grey picture, does not return a list of LandmarkDetection with the
        largest first, finds others the second time, or writes to the picture.

    Examples
    --------
    >>> from toongeo import detect_faces
    >>> check_landmark_detector(detect_faces)
    """
    picture = np.array(example()[0] if img is None else img)
    before = picture.copy()
    found, again = detector(picture), detector(picture)
    unchanged("img", before, picture)
    require(isinstance(found, list), f"detector: expected a list, got {type(found).__name__}")
    require(found, "detector: expected a face in the picture, got none")
    size = np.array(picture.shape[1::-1])
    for face, other in zip(found, again, strict=True):
        require(isinstance(face, LandmarkDetection), f"detector: expected LandmarkDetection, got {type(face).__name__}")
        require(np.array_equal(face.points, other.points), "points: expected the same a second time")
        inside = (face.points > -_INSIDE * size).all() and (face.points < (1 + _INSIDE) * size).all()
        require(inside, "points: expected pixels of the picture, got some far outside of it")
        eyes = face.points[[36, 45]]
        require(eyes[0, 0] < eyes[1, 0], "points: expected iBUG-68: 36 is the subject's right eye, left in the picture")
        require(face.points[8, 1] > face.points[27, 1], "points: expected y down: the chin below the nose")
    areas = [float(np.prod(face.box[2:] - face.box[:2])) for face in found]
    require(areas == sorted(areas, reverse=True), "detector: expected the largest face first")
    grey = np.full((96, 96, 3), 128, np.uint8)
    require(detector(grey) == [], "detector: expected no face in a grey picture")
