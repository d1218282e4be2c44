"""MediaPipe's Face Landmarker (the extra ``mediapipe``)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io import ibug_points
from toongeo.protocols import LandmarkDetection

__all__ = ["MediapipeDetector"]


class MediapipeDetector:
    """A `LandmarkDetector`: a ``.task`` file of yours, which gives 478 points and the weights of 52 expressions.

    Parameters
    ----------
    path : str or Path
        ``face_landmarker.task``.
    most : int
        Of faces in a picture.
    confidence : float in [0, 1]
        Of every point and face; MediaPipe tells none.

    Raises
    ------
    OSError
        If the file is missing.
    ImportError
        If mediapipe is not installed.

    Examples
    --------
    >>> detector = MediapipeDetector("face_landmarker.task")  # doctest: +SKIP
    >>> tg.make_avatar(img, detector=detector)  # doctest: +SKIP
    >>> tg.expression_weights(detector.expressions(img)[0])  # doctest: +SKIP
    """

    def __init__(self, path: str | os.PathLike[str], *, most: int = 5, confidence: float = 0.9) -> None:
        try:
            import mediapipe
        except ImportError as error:
            raise ImportError("landmarks by MediaPipe need mediapipe: pip install toongeo[mediapipe]") from error
        if not Path(path).is_file():
            raise FileNotFoundError(f"path: no task {path}")
        if not 0 <= confidence <= 1:
            raise ValueError(f"confidence: expected a number in [0, 1], got {confidence}")
        vision = mediapipe.tasks.vision
        options = vision.FaceLandmarkerOptions(
            base_options=mediapipe.tasks.BaseOptions(model_asset_path=str(path)),
            num_faces=most,
            output_face_blendshapes=True,
        )
        self._mediapipe: Any = mediapipe
        self._landmarker: Any = vision.FaceLandmarker.create_from_options(options)
        self._confidence = confidence

    def __call__(self, img: NDArray[np.uint8]) -> list[LandmarkDetection]:
        """The faces of the picture (H, W, 3) uint8, the largest first, as 68 of their points."""
        trust = np.full(68, self._confidence)
        found = [
            LandmarkDetection(ibug_points(points[:, :2], "mediapipe478"), trust, self._confidence)
            for points in self.points(img)
        ]
        return sorted(found, key=lambda face: -float(np.prod(face.box[2:] - face.box[:2])))

    def points(self, img: NDArray[np.uint8]) -> list[NDArray[np.float64]]:
        """All points (478, 3) px of each face, in MediaPipe's order: x right, y down, depth away from the viewer."""
        height, width = img.shape[:2]
        # A share of the picture, counted from the border of its first pixel, whose centre is 0 here.
        return [
            np.array([(p.x * width - 0.5, p.y * height - 0.5, p.z * width) for p in face], np.float64)
            for face in self._detected(img).face_landmarks
        ]

    def expressions(self, img: NDArray[np.uint8]) -> list[dict[str, float]]:
        """Weights in [0, 1] of each face by MediaPipe's names, which :func:`toongeo.expression_weights` takes."""
        return [
            {category.category_name: float(category.score) for category in face}
            for face in self._detected(img).face_blendshapes
        ]

    def _detected(self, img: NDArray[np.uint8]) -> Any:
        image = self._mediapipe.Image(
            image_format=self._mediapipe.ImageFormat.SRGB, data=np.ascontiguousarray(img, np.uint8)
        )
        return self._landmarker.detect(image)
