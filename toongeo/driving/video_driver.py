"""Weights from a video of a performer."""

from __future__ import annotations

from collections.abc import Iterable

from numpy.typing import ArrayLike

from toongeo.arrays import Bytes, Floats
from toongeo.avatar.avatar import Avatar
from toongeo.driving.landmark_driver import LandmarkDriver
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.driving.performer_of_frames import performer_of_frames
from toongeo.driving.take import Take
from toongeo.io import Video
from toongeo.model.expression_schemes import EXPRESSIONS
from toongeo.pipeline import track_landmarks
from toongeo.protocols import LandmarkDetector

__all__ = ["CAUTION", "VideoDriver"]

CAUTION = 5.0  # of LandmarkDriver, for points that were found; chosen on films of astronaut and moustache_man


class VideoDriver:
    """Reads the expression off a film of a performer, as an :class:`toongeo.ExpressionDriver`.

    :func:`toongeo.track_landmarks` follows the face, :class:`LandmarkDriver` reads the weights. While the face is lost,
    the last weights are held. Weights are as good as the points: on films like photographs they are near to the truth,
    on films of drawn faces not yet (``benchmarks/RESULTS.md``).

    Parameters
    ----------
    performer : Avatar, LandmarkRig, (68, 2) px landmarks of a neutral frame, or None
        As of :class:`LandmarkDriver`; with None a neutral frame is found in the film itself, so the performer should
        look into the camera without expression for a moment.
    detector : LandmarkDetector, optional
        What finds the face; :func:`toongeo.detect_faces` unless another is given.

    Examples
    --------
    >>> from toongeo.driving import VideoDriver
    >>> from toongeo.io import read_image
    >>> from toongeo.model import data_path
    >>> frame = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> VideoDriver().frames([frame, frame], fps=15).shape
    (2, 54)
    """

    names = EXPRESSIONS

    def __init__(
        self,
        performer: Avatar | LandmarkRig | ArrayLike | None = None,
        *,
        detector: LandmarkDetector | None = None,
    ) -> None:
        self._performer, self._detector = performer, detector

    def frames(self, recording: Iterable[Bytes], fps: float = 30.0) -> Floats:
        """Weights (f, 54) in [0, 1] of the expressions ``names``.

        Parameters
        ----------
        recording : iterable of (H, W, 3) uint8 RGB
            All of one size.
        fps : float
            Frames a second.

        Raises
        ------
        NoFaceError
            A ValueError: if no frame shows a face.
        ValueError
            As of :func:`toongeo.track_landmarks`.
        """
        seen = track_landmarks(recording, fps=fps, detector=self._detector).seen
        performer = performer_of_frames(seen) if self._performer is None else self._performer
        return LandmarkDriver(performer, caution=CAUTION).frames(seen, fps)

    def take(self, video: Video) -> Take:
        """The same with its times.

        Raises
        ------
        ValueError
            As of :meth:`frames`; names the file.
        """
        try:
            return Take.of_frames(self.frames(video, video.fps), video.fps)
        except ValueError as error:
            raise type(error)(f"{video.path}: {error}") from error
