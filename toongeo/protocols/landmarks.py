"""Landmarks that are found, and their finders."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from toongeo._brief_repr import brief_repr

__all__ = ["LandmarkDetection", "LandmarkDetector"]

_INNER, _EYES, _MOUTH = slice(17, 68), slice(36, 48), slice(48, 68)
_FACE = 0.5  # more likely a face than not
_PLACED, _PART_PLACED = 0.75, 0.65  # mean confidences; chosen on half of 220 strange renders, no worse on the others


@dataclass(frozen=True, eq=False)
class LandmarkDetection:
    """A face that was found in a picture.

    Attributes
    ----------
    points : (68, 2) float64 px
        iBUG-68 order; x right, y down, integer = pixel centre.
    confidence : (68,) float64 in [0, 1]
        The chance of each point to lie within 8 % of the outer-eye distance from its place.
    score : float in [0, 1]
        The chance that this is a face at all.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> found = tg.detect_landmarks(img)
    >>> found.points.shape, found.confidence.shape, 0 < found.score <= 1
    ((68, 2), (68,), True)
    """

    points: np.ndarray
    confidence: np.ndarray
    score: float

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        points, confidence = np.array(self.points, np.float64), np.array(self.confidence, np.float64)
        if points.shape != (68, 2) or not np.isfinite(points).all():
            raise ValueError(f"points: expected (68, 2) finite px, got {points.shape} or NaN or infinity")
        if confidence.shape != (68,) or not ((confidence >= 0) & (confidence <= 1)).all():
            raise ValueError(f"confidence: expected (68,) numbers in [0, 1], got {confidence.shape} or others")
        if not 0 <= self.score <= 1:
            raise ValueError(f"score: expected a number in [0, 1], got {self.score}")
        for name, array in (("points", points), ("confidence", confidence)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def box(self) -> np.ndarray:
        """(4,) px: left, top, right and bottom of the points."""
        return np.concatenate([self.points.min(axis=0), self.points.max(axis=0)])

    @property
    def is_sure(self) -> bool:
        """Whether this is likely a face whose points are mostly in their places; if not, a person should look.

        It asks for inner points that are mostly sure, and for eyes and a mouth that are: brows and noses are doubtful
        on many a good face. Of 220 faces found in renders that nothing was trained on, bent, screened and hatched, this
        tells 9 of the 10 whose error is above 0.1 of the outer-eye distance, and takes 16 of 177 good ones (below 0.06)
        for such.
        """
        least = min(float(self.confidence[part].mean()) for part in (_EYES, _MOUTH))
        return self.score >= _FACE and float(self.confidence[_INNER].mean()) >= _PLACED and least >= _PART_PLACED


class LandmarkDetector(Protocol):
    """Finds the faces of a picture and their landmarks; a network, say, or `detect_faces`.

    :func:`toongeo.testing.check_landmark_detector` checks one; ``make_avatar(img, detector=...)`` and
    ``detect_landmarks(img, detector=...)`` use it, or the name under which a package offers it
    (:func:`toongeo.plugins.plugin`). Adapters to dlib and MediaPipe: :mod:`toongeo.adapters`.

    Examples
    --------
    >>> from toongeo.testing import check_landmark_detector
    >>> from toongeo.testing.example import example
    >>> class Remembered:
    ...     "Knows one picture."
    ...     def __call__(self, img):
    ...         picture, points = example()
    ...         if not np.array_equal(img, picture):
    ...             return []
    ...         return [LandmarkDetection(points, np.ones(68), score=1.0)]
    >>> check_landmark_detector(Remembered())
    """

    def __call__(self, img: np.ndarray) -> list[LandmarkDetection]:
        """The faces of the picture (H, W, 3) uint8, the largest first."""
        ...
