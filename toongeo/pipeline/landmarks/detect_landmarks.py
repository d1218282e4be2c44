"""The landmarks of one face of a picture."""

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.detect_faces import detect_faces
from toongeo.plugins import plugin
from toongeo.protocols import LandmarkDetection, LandmarkDetector

__all__ = ["NoFaceError", "detect_landmarks"]


class NoFaceError(ValueError):
    """No face was found where one is needed, or fewer than asked for."""


def detect_landmarks(
    img: NDArray[np.uint8], *, face: int = 0, detector: str | LandmarkDetector | None = None
) -> LandmarkDetection:
    """The 68 landmarks of a face, and how far each is to be trusted.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : int
        Which face, if there are several: 0 is the largest.
    detector : LandmarkDetector or str, optional
        :func:`detect_faces`, which needs no network, unless another is given, or the name of one that an installed
        package offers (:mod:`toongeo.plugins`).

    Returns
    -------
    LandmarkDetection

    Raises
    ------
    NoFaceError
        A ValueError: if no face was found, or not so many.
    ValueError
        If the picture is not (H, W, 3) uint8, `face` is negative, or no package offers such a detector.

    Examples
    --------
    >>> from toongeo.io import read_image
    >>> from toongeo.model import data_path
    >>> found = detect_landmarks(read_image(data_path("examples/portraits/moustache_man.png")))
    >>> found.points.shape, found.is_sure
    ((68, 2), True)
    """
    if face < 0:
        raise ValueError(f"face: expected 0 for the largest face, 1 for the next, ..., got {face}")
    found = (plugin(detector, "detector") or detect_faces)(img)
    if len(found) <= face:
        count = {0: "no face was found", 1: "only one face was found"}.get(
            len(found), f"only {len(found)} faces were found"
        )
        raise NoFaceError(
            f"img: {count} in the picture of {img.shape[1]} x {img.shape[0]} px; give the 68 points "
            "(--landmarks FILE), or place them with the editor: toongeo landmarks IMAGE"
        )
    return found[face]
