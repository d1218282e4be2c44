"""Weights from a video of a performer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Bytes, Floats
from toongeo.avatar.avatar import Avatar
from toongeo.driving.landmark_driver import LandmarkDriver
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.driving.one_euro_filter import smoothed_both_ways
from toongeo.driving.picture.reader_of_film import is_seen, reader_of_film
from toongeo.driving.take import Take
from toongeo.io import Video
from toongeo.model.expression_schemes import EXPRESSIONS
from toongeo.pipeline import track_landmarks
from toongeo.protocols import LandmarkDetector

__all__ = ["CAUTION", "VideoDriver"]

_NOISE = 0.01  # s.d. of a weight of a still face
_NEAR = 0.25  # s: nobody reads the time of a frame off a player more exactly
CAUTION = 5.0  # of LandmarkDriver, for points that were found; chosen on films of astronaut and moustache_man


class VideoDriver:
    """Reads the expression off a film of a performer, as an :class:`toongeo.ExpressionDriver`.

    :func:`toongeo.track_landmarks` follows the face. A frame in which it shows no expression is looked for, and in all
    others the skin of that frame is found again, moved by pose and expression: landmarks only say where to start, and
    where they miss in every frame alike, it does little harm. While the face is lost, the last weights are held. What
    to expect is told in ``benchmarks/RESULTS.md``.

    Parameters
    ----------
    performer : Avatar, LandmarkRig, (68, 2) px landmarks of a neutral frame, or None
        With None a neutral frame is found in the film itself, so the performer should look into the camera without
        expression for a moment. Of another performer no neutral frame is known: weights are then read off the landmarks
        alone, as by :class:`LandmarkDriver`.
    detector : LandmarkDetector, optional
        What finds the face; :func:`toongeo.detect_faces` unless another is given.
    neutral : float, optional
        Seconds from the beginning of the film to a frame in which its performer looks into the camera without
        expression. It is looked for if None, and a mistake in it is in all weights: who knows it should say it.

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
        neutral: float | None = None,
    ) -> None:
        if neutral is not None and performer is not None:
            raise ValueError("neutral: expected none for a performer whose neutral face is known")
        if neutral is not None and not (np.isfinite(neutral) and neutral >= 0):
            raise ValueError(f"neutral: expected a number of seconds >= 0, got {neutral}")
        self._performer, self._detector, self._neutral = performer, detector, neutral

    def frames(self, recording: Iterable[Bytes], fps: float = 30.0) -> Floats:
        """Weights (f, 54) in [0, 1] of the expressions ``names``.

        Parameters
        ----------
        recording : iterable of (H, W, 3) uint8 RGB
            All of one size. It is gone through several times; of an iterator the frames are kept.
        fps : float
            Frames a second.

        Raises
        ------
        NoFaceError
            A ValueError: if no frame shows a face.
        ValueError
            As of :func:`toongeo.track_landmarks`.
        """
        frames = list(recording) if isinstance(recording, Iterator) else recording
        seen = track_landmarks(frames, fps=fps, detector=self._detector).seen
        if self._performer is not None:
            return LandmarkDriver(self._performer, caution=CAUTION).frames(seen, fps)
        reader = reader_of_film(frames, seen, self._frame_at(seen, fps))
        there = np.array([is_seen(landmarks) for landmarks in seen])
        weights = np.zeros((len(seen), len(reader.skin.rig.names)))
        for k, (frame, landmarks) in enumerate(zip(frames, seen, strict=True)):
            if there[k]:
                weights[k] = reader(frame, landmarks).weights
            else:
                reader.lost()
        held = np.maximum.accumulate(np.where(there, np.arange(len(there)), there.argmax()))
        weights = weights[held]
        weights = smoothed_both_ways(weights[:, :, None], _NOISE, fps)[:, :, 0]
        return reader.skin.rig.all_weights(weights)

    def _frame_at(self, seen: Floats, fps: float) -> int | None:
        """The frame in which the performer is said to be neutral, or the next to it that shows the whole face."""
        if self._neutral is None:
            return None
        if round(self._neutral * fps) >= len(seen):
            raise ValueError(f"neutral: expected a time in the film of {len(seen) / fps:.2f} s, got {self._neutral}")
        away = np.abs(np.arange(len(seen)) / fps - self._neutral)
        away[~np.isfinite(seen).all(axis=(1, 2))] = np.inf
        if away.min() > max(_NEAR, 1 / fps):
            raise ValueError(f"neutral: expected a time at which the whole face is seen, got {self._neutral}")
        return int(away.argmin())

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
