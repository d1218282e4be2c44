"""Expression weights from the landmarks of another face.

Constants were judged on the heads of the seven examples (``benchmarks/driving.py``).
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats
from toongeo.avatar.avatar import Avatar
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.driving.landmarks.landmark_frames import landmark_frames
from toongeo.driving.landmarks.landmark_noise import FIRST_NOISE, doubt_of, noise_of
from toongeo.driving.landmarks.landmark_pose import FEWEST, landmark_pose, landmark_poses
from toongeo.driving.one_euro_filter import OneEuroFilter, smoothed_both_ways
from toongeo.driving.performer_of_frames import performer_of_frames
from toongeo.geometry.one_thread import one_thread
from toongeo.model.expression_schemes import EXPRESSIONS
from toongeo.pipeline import Rig

__all__ = ["LandmarkDriver", "LiveLandmarks"]

_CAUTION = 2.0  # as chosen for landmarks that are exact but for noise
_REMEMBERED = 90  # frames from which live noise is told


class LandmarkDriver:
    """Reads the expression off the landmarks of a performer, as an :class:`toongeo.ExpressionDriver`.

    Each frame is explained by the performer's own face: its pose in the picture (scaled orthographic) and its weights,
    by least squares within bounds. Weights, unlike distances, mean the same on every face, so they drive any avatar.
    The landmarks are smoothed in the frame of the head by a One-Euro filter, so that turns of the head are not.

    Parameters
    ----------
    performer : Avatar, LandmarkRig, (68, 2) px landmarks of a neutral frame, or None
        Whose landmarks will be seen. The better it is known, the better the weights: an avatar of the performer knows
        most; of a neutral frame a face is fitted; with None a neutral frame is found in the sequence itself.
    scheme : str
        What all landmarks are: see :func:`toongeo.ibug_landmarks`.
    caution : float
        How much more noise the weights assume than the landmarks show: quiet weights are worth a little bias. Points
        that were found in pictures err together, as no noise does, and want about 5.

    Raises
    ------
    ValueError
        If landmarks have another shape, or the caution is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> from toongeo.driving import LandmarkDriver
    >>> model = default_model()
    >>> neutral = model.mean[model.landmarks, :2] * [1, -1]
    >>> smile = neutral + 0.5 * model.expression[model.expression_index("jawOpen"), model.landmarks, :2] * [1, -1]
    >>> driver = LandmarkDriver(neutral)
    >>> weights = driver.frames(np.stack([neutral, smile]))
    >>> driver.names[weights[1].argmax()]
    'jawOpen'
    """

    names = EXPRESSIONS

    def __init__(
        self,
        performer: Avatar | LandmarkRig | ArrayLike | None = None,
        *,
        scheme: str = "ibug68",
        caution: float = _CAUTION,
    ) -> None:
        if not (np.isfinite(caution) and caution > 0):
            raise ValueError(f"caution: expected a factor > 0, got {caution!r}")
        self._scheme, self._caution = scheme, caution
        self._rig: LandmarkRig | None
        if performer is None or isinstance(performer, LandmarkRig):
            self._rig = performer
        elif isinstance(rig := getattr(performer, "rig", None), Rig):
            self._rig = LandmarkRig.of_rig(rig, performer.face.landmark_vertices)  # type: ignore[union-attr]
        else:
            self._rig = LandmarkRig.of_neutral(landmark_frames(performer, "performer", scheme)[0])

    def frames(self, recording: ArrayLike, fps: float = 30.0) -> Floats:
        """Weights (f, 54) in [0, 1] of the expressions ``names`` for a whole sequence.

        What comes after a frame is known too, so it is smoothed without delay: once forwards, once backwards. Gaze,
        which the landmarks do not show, is 0.

        Parameters
        ----------
        recording : (f, 68, 2) px
            iBUG-68 landmarks, x right, y down; NaN rows are missing, and a frame with fewer than 12 points repeats
            what was there before.
        fps : float
            Frames a second.

        Raises
        ------
        ValueError
            If the shape is another, the rate is not positive, or no frame has enough landmarks.
        """
        sequence = landmark_frames(recording, scheme=self._scheme)
        if not (np.isfinite(fps) and fps > 0):
            raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
        with one_thread():
            rig = performer_of_frames(sequence) if self._rig is None else self._rig
            poses = landmark_poses(rig, sequence, FIRST_NOISE)
            errors = np.array([pose.errors(x, rig) for pose, x in zip(poses, sequence, strict=True)])
            noise, doubt = noise_of(errors), doubt_of(errors, self._caution)
            moved = np.array([pose.head_frame(x, rig) for pose, x in zip(poses, sequence, strict=True)])
            moved = smoothed_both_ways(moved, noise * rig.width, fps)
            weights, rows = np.zeros(len(rig.names)), []
            for pose, there in zip(poses, moved, strict=True):
                weights = landmark_pose(rig, pose.picture(there, rig), weights, doubt).weights
                rows.append(weights)
        return rig.all_weights(np.array(rows))

    def live(self) -> LiveLandmarks:
        """For frames that come one by one.

        Raises
        ------
        ValueError
            If the performer is not known: their face cannot be found from frames that have not come yet.
        """
        if self._rig is None:
            raise ValueError("performer: expected an avatar or a neutral frame for live driving, got None")
        return LiveLandmarks(self._rig, self._scheme, self._caution)


class LiveLandmarks:
    """Weights of one frame after the other; made by :meth:`LandmarkDriver.live`.

    Smooths by what has come so far, so it follows a little later than :meth:`LandmarkDriver.frames`.

    Examples
    --------
    >>> import toongeo as tg
    >>> model = tg.default_model()
    >>> neutral = model.mean[model.landmarks, :2] * [1, -1]  # px of a performer at rest
    >>> live = tg.LandmarkDriver(neutral).live()
    >>> live(neutral, 0.0).shape, live(neutral, 0.04).shape
    ((54,), (54,))
    """

    def __init__(self, rig: LandmarkRig, scheme: str = "ibug68", caution: float = _CAUTION) -> None:
        self._rig, self._scheme, self._caution = rig, scheme, caution
        self._weights = [np.zeros(len(rig.names)), np.zeros(len(rig.names))]  # of the frame as it is, and smoothed
        self._filter = OneEuroFilter(FIRST_NOISE * rig.width)
        self._errors: deque[Floats] = deque(maxlen=_REMEMBERED)

    def __call__(self, landmarks: ArrayLike, time: float) -> Floats:
        """Weights (54,) in [0, 1] of landmarks (68, 2) px at a time in s.

        A frame with fewer than 12 landmarks repeats the last weights.

        Raises
        ------
        ValueError
            If the landmarks have another shape or are infinite.
        """
        rig, pixels = self._rig, landmark_frames(landmarks, "landmarks", self._scheme)[0]
        if np.isfinite(pixels).all(axis=1).sum() >= FEWEST:
            with one_thread():
                pose = landmark_pose(rig, pixels, self._weights[0], FIRST_NOISE)
                self._errors.append(pose.errors(pixels, rig))
                noise = noise_of(np.array(self._errors))
                self._filter.noise = noise * rig.width
                there = self._filter(pose.head_frame(pixels, rig), time)
                smooth = landmark_pose(rig, pose.picture(there, rig), self._weights[1], self._caution * noise)
            self._weights = [pose.weights, smooth.weights]
        return rig.all_weights(self._weights[1][None])[0]
