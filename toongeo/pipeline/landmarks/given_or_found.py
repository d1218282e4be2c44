"""Landmarks that are given, or else found in the picture."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.pipeline.landmarks.detect_landmarks import detect_landmarks

__all__ = ["given_or_found"]


def given_or_found(
    img: NDArray[np.uint8] | None, landmarks: ArrayLike | None, scheme: Any = "ibug68"
) -> ArrayLike | NDArray[np.float64]:
    """The landmarks as they are given or, for None, the 68 of the largest face that :func:`detect_landmarks` finds.

    Raises
    ------
    NoFaceError
        A ValueError: if no face was found.
    ValueError
        If there is no picture to look in, or the scheme is another one than iBUG-68.
    """
    if landmarks is not None:
        return landmarks
    if img is None:
        raise ValueError("landmarks: expected points where there is no picture to find them in, got None")
    if not (isinstance(scheme, str) and scheme == "ibug68"):
        raise ValueError(f"scheme: expected 'ibug68' for landmarks that are to be found, got {scheme!r}")
    return detect_landmarks(img).points
