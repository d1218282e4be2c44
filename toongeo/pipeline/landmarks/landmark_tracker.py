"""Landmarks of frames that come one by one."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.pipeline.landmarks.detect_faces import detect_faces
from toongeo.pipeline.landmarks.landmark_track import TrackedFace
from toongeo.pipeline.landmarks.search.detector_file import shipped_detector
from toongeo.pipeline.landmarks.search.follow_face import flowed_points, follow_face
from toongeo.protocols import LandmarkDetection, LandmarkDetector

__all__ = ["LandmarkTracker"]

# Chances of a face: on films of drawn avatars those of seen faces are 0.3 and more, of covered ones 0.01 at most. One
# that is followed may look odd for a frame, one that was lost must be surer.
_STILL_THERE, _BACK = 0.2, 0.7
_LOOK_EVERY = 0.2  # s between searches of the whole picture: a search takes some 0.25 s, and 0.5 s is how long a face
# that is back may go unseen


class LandmarkTracker:
    """Follows one face through a video, frame by frame.

    The detector finds the face at the start. From then on optical flow says where its points went, and the cascade of
    the detector, started there, where they are: nothing adds up over time. When the face is no longer seen its last
    points are held; it is looked for where it was in every frame, and everywhere five times a second.

    Parameters
    ----------
    detector : LandmarkDetector, optional
        What finds the face: :func:`detect_faces` unless another is given. Of several faces the largest is followed,
        and after it was lost the one that is nearest to where it was.
    thorough : bool
        Look at each frame as carefully as :func:`detect_faces` looks at a face: about 0.1 s a frame rather than 0.04.

    References
    ----------
    J.-Y. Bouguet, "Pyramidal implementation of the Lucas Kanade feature tracker", 2000. Points followed there and back:
    Z. Kalal, K. Mikolajczyk, J. Matas, "Forward-backward error", ICPR 2010.

    Examples
    --------
    >>> from toongeo.io import read_image
    >>> from toongeo.model import data_path
    >>> tracker = LandmarkTracker()
    >>> frame = read_image(data_path("examples/portraits/moustache_man.png"))
    >>> [tracker.track(frame, k / 15).lost for k in range(2)], tracker.track(np.zeros_like(frame), 2 / 15).lost
    ([False, False], True)
    """

    def __init__(self, detector: LandmarkDetector | None = None, *, thorough: bool = False) -> None:
        self._detector = detector or detect_faces
        self._thorough = thorough
        self._parts = shipped_detector()
        self._grey: NDArray[np.uint8] | None = None
        self._points = np.full((68, 2), np.nan)
        self._lost = True
        self._time = self._looked = -np.inf

    def track(self, frame: NDArray[np.uint8], time: float) -> TrackedFace:
        """The face in the next frame.

        Parameters
        ----------
        frame : (H, W, 3) uint8 RGB
            Of the same size as the ones before.
        time : float, s
            Later than that of the frame before.

        Raises
        ------
        ValueError
            If the frame is not (H, W, 3) uint8 or has another size than the first one, or the time does not increase.
        """
        check_image(frame, "frame")
        if self._grey is not None and frame.shape[:2] != self._grey.shape:
            raise ValueError(
                f"frame: expected {_size(self._grey.shape)} px as in the frames before, got {_size(frame.shape)}"
            )
        if not (np.isfinite(time) and time > self._time):
            raise ValueError(f"time: expected seconds after {self._time}, those of the frame before, got {time}")
        grey = np.asarray(cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY), np.uint8)
        found = self._followed(grey)
        if found is None and time - self._looked >= _LOOK_EVERY - 1e-6:
            self._looked = time
            found = self._nearest(self._detector(frame))
        self._grey, self._time, self._lost = grey, time, found is None
        if found is None:
            return TrackedFace(self._points, np.zeros(68), 0.0, True)
        self._points = found.points
        return TrackedFace(found.points, found.confidence, found.score, False)

    def _followed(self, grey: NDArray[np.uint8]) -> LandmarkDetection | None:
        """The face near where it was, if it is there."""
        if self._grey is None or np.isnan(self._points).any():
            return None
        start = self._points if self._lost else flowed_points(self._grey, grey, self._points)
        with one_thread():  # how BLAS splits a sum among threads would show in the last digits
            face = follow_face(grey, start, self._parts, thorough=self._thorough)
        if face.chance < (_BACK if self._lost else _STILL_THERE):
            return None
        return LandmarkDetection(face.points, face.confidence, face.chance)

    def _nearest(self, faces: list[LandmarkDetection]) -> LandmarkDetection | None:
        if not faces or np.isnan(self._points).any():
            return faces[0] if faces else None
        return min(faces, key=lambda face: float(np.linalg.norm((face.points - self._points).mean(axis=0))))


def _size(shape: tuple[int, ...]) -> str:
    return f"{shape[1]} x {shape[0]}"
