"""dlib's 68 points (the extra ``dlib``)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.protocols import LandmarkDetection

__all__ = ["DlibDetector"]

_N = 68


class DlibDetector:
    """A `LandmarkDetector`: dlib's face detector and a shape predictor of yours.

    No model comes along: the usual one, ``shape_predictor_68_face_landmarks.dat``, was trained on pictures for research
    only (300-W), so whether you may use it is for you to know.

    Parameters
    ----------
    path : str or Path
        A shape predictor with 68 points in iBUG order.
    upsample : int
        How often the picture is doubled before faces are looked for: 1 finds faces of 40 px.
    confidence : float in [0, 1]
        Of every point; dlib tells none.

    Raises
    ------
    OSError
        If the file is missing.
    ImportError
        If dlib is not installed.

    Examples
    --------
    >>> detector = DlibDetector("shape_predictor_68_face_landmarks.dat")  # doctest: +SKIP
    >>> tg.make_avatar(img, detector=detector)  # doctest: +SKIP

    References
    ----------
    V. Kazemi, J. Sullivan, "One millisecond face alignment with an ensemble of regression trees", CVPR 2014.
    """

    def __init__(self, path: str | os.PathLike[str], *, upsample: int = 1, confidence: float = 0.9) -> None:
        try:
            import dlib
        except ImportError as error:
            raise ImportError("landmarks by dlib need dlib: pip install toongeo[dlib]") from error
        if not Path(path).is_file():
            raise FileNotFoundError(f"path: no shape predictor {path}")
        if not 0 <= confidence <= 1:
            raise ValueError(f"confidence: expected a number in [0, 1], got {confidence}")
        self._faces: Any = dlib.get_frontal_face_detector()
        self._points: Any = dlib.shape_predictor(str(path))
        self._upsample, self._confidence = upsample, confidence

    def __call__(self, img: NDArray[np.uint8]) -> list[LandmarkDetection]:
        """The faces of the picture (H, W, 3) uint8, the largest first."""
        # Pixel centres of dlib are whole numbers, as ours.
        picture = np.ascontiguousarray(img)
        boxes, scores, _ = self._faces.run(picture, self._upsample, 0.0)
        found = []
        for box, score in zip(boxes, scores, strict=True):
            shape = self._points(picture, box)
            if shape.num_parts != _N:
                raise ValueError(f"path: expected a predictor of {_N} points, got {shape.num_parts}")
            points = np.array([(shape.part(k).x, shape.part(k).y) for k in range(_N)], np.float64)
            chance = 1 / (1 + np.exp(-float(score)))  # the margin of its linear classifier
            found.append(LandmarkDetection(points, np.full(_N, self._confidence), float(chance)))
        return sorted(found, key=lambda face: -float(np.prod(face.box[2:] - face.box[:2])))
