"""The landmarks of one face through a video."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored

__all__ = ["LandmarkTrack", "TrackedFace"]


@dataclass(frozen=True, eq=False)
class TrackedFace:
    """A face in one frame.

    Attributes
    ----------
    points : (68, 2) float64 px
        iBUG-68 order. Of a face that is lost, where it was last; NaN before any was found.
    confidence : (68,) float64 in [0, 1]
        As of :class:`toongeo.LandmarkDetection`; 0 while the face is lost.
    score : float in [0, 1]
        The chance that there is a face; 0 while it is lost.
    lost : bool
    """

    points: NDArray[np.float64]
    confidence: NDArray[np.float64]
    score: float
    lost: bool

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "points", "confidence")


@dataclass(frozen=True, eq=False)
class LandmarkTrack:
    """A face in every frame of a video.

    Attributes
    ----------
    points : (f, 68, 2) float64 px
        iBUG-68 order; x right, y down, integer = pixel centre. Where the face is lost, where it was last; NaN before
        it was found for the first time.
    confidence : (f, 68) float64 in [0, 1]
        As of :class:`toongeo.LandmarkDetection`; 0 where the face is lost.
    score : (f,) float64 in [0, 1]
        The chance of each frame to show the face; 0 where it is lost.
    lost : (f,) bool
    times : (f,) float64, s
        Increasing.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> track = tg.track_landmarks([img, img])
    >>> track.points.shape, track.lost, track.times
    ((2, 68, 2), array([False, False]), array([0.        , 0.03333333]))
    >>> track.seen.shape  # NaN where the face is lost
    (2, 68, 2)
    """

    points: NDArray[np.float64]
    confidence: NDArray[np.float64]
    score: NDArray[np.float64]
    lost: NDArray[np.bool_]
    times: NDArray[np.float64]

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        count = len(self.times)
        shapes = {
            "points": (count, 68, 2),
            "confidence": (count, 68),
            "score": (count,),
            "lost": (count,),
        }
        for name, shape in shapes.items():
            if np.shape(getattr(self, name)) != shape:
                raise ValueError(f"{name}: expected {shape}, got {np.shape(getattr(self, name))}")
        read_only(self, *shapes, "times")

    @property
    def seen(self) -> NDArray[np.float64]:
        """The points (f, 68, 2) px with NaN where the face is lost, as :class:`toongeo.LandmarkDriver` takes them."""
        return np.where(self.lost[:, None, None], np.nan, self.points)
