"""The landmarks of a face through a whole video."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.detect_landmarks import NoFaceError
from toongeo.pipeline.landmarks.landmark_track import LandmarkTrack
from toongeo.pipeline.landmarks.landmark_tracker import LandmarkTracker
from toongeo.protocols import LandmarkDetector

__all__ = ["track_landmarks"]


def track_landmarks(
    frames: Iterable[NDArray[np.uint8]], *, fps: float = 30.0, detector: LandmarkDetector | None = None
) -> LandmarkTrack:
    """The 68 landmarks of one face in every frame of a video; see :class:`LandmarkTracker`, made thorough, for how.

    Parameters
    ----------
    frames : iterable of (H, W, 3) uint8 RGB
        All of one size, such as :func:`toongeo.read_video` gives; they are looked at one by one, and none is kept.
    fps : float
        Frames a second.
    detector : LandmarkDetector, optional
        What finds the face at the start and when it was lost; :func:`detect_faces` unless another is given.

    Returns
    -------
    LandmarkTrack
        ``track.seen`` is what :class:`toongeo.LandmarkDriver` takes.

    Raises
    ------
    NoFaceError
        A ValueError: if no frame shows a face.
    ValueError
        If there is no frame, one is not (H, W, 3) uint8 or of another size than the first, or the rate is not
        positive.

    Examples
    --------
    >>> from toongeo.io import read_image
    >>> from toongeo.model import data_path
    >>> frame = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> track = track_landmarks([frame, frame], fps=15)
    >>> track.points.shape, track.lost.any()
    ((2, 68, 2), np.False_)
    """
    if not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
    tracker = LandmarkTracker(detector, thorough=True)
    faces = [tracker.track(frame, k / fps) for k, frame in enumerate(frames)]
    if not faces:
        raise ValueError("frames: expected at least one frame, got none")
    if all(face.lost for face in faces):
        raise NoFaceError(f"frames: no face was found in any of {len(faces)} frames")
    return LandmarkTrack(
        np.array([face.points for face in faces]),
        np.array([face.confidence for face in faces]),
        np.array([face.score for face in faces]),
        np.array([face.lost for face in faces]),
        np.arange(len(faces)) / fps,
    )
