"""A video file as frames."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.reading.check_file import check_file
from toongeo.reading.promise import promised

__all__ = ["Video", "read_video"]

_MOST_MB = 1 << 20  # read frame by frame, so any size; only pipes and devices are refused
_USUAL_FPS = 30.0  # of a file that does not say
_MOST_FPS = 1000.0  # what claims more tells the ticks of its clock


@dataclass(frozen=True)
class Video:
    """A video that is read while one goes through it; each time from the start.

    Attributes
    ----------
    path : Path
    fps : float
        Frames a second.
    size : (int, int)
        Height and width of a frame, px. Of a file whose frames change in size, OpenCV scales all to that of the first.
    """

    path: Path
    fps: float
    size: tuple[int, int]

    def __iter__(self) -> Iterator[NDArray[np.uint8]]:
        """Frames (H, W, 3) uint8 RGB, upright as the file says."""
        capture = cv2.VideoCapture(str(self.path))
        try:
            while (read := capture.read())[0]:
                yield np.asarray(cv2.cvtColor(read[1], cv2.COLOR_BGR2RGB), np.uint8)
        finally:
            capture.release()


@promised("a video")
def read_video(path: str | os.PathLike[str]) -> Video:
    """Open a video that OpenCV can decode.

    Parameters
    ----------
    path
        ``.mp4``, ``.mov``, ``.avi``, ``.webm`` ...: what is in a file counts, not its name.

    Returns
    -------
    Video
        To go through: ``for frame in video``. Nothing but its first frames has been read.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is no video or empty, none of its frames can be decoded, or there is only one, as in a picture.

    Examples
    --------
    >>> import numpy as np
    >>> import cv2
    >>> import toongeo as tg
    >>> film = cv2.VideoWriter("film.avi", cv2.VideoWriter_fourcc(*"MJPG"), 25, (64, 48))
    >>> for k in range(5):
    ...     _ = film.write(np.full((48, 64, 3), 50 * k, dtype=np.uint8))
    >>> film.release()
    >>> video = tg.read_video("film.avi")
    >>> video.fps, [frame.shape for frame in video][:2]
    (25.0, [(48, 64, 3), (48, 64, 3)])
    """
    path = Path(path)
    check_file(path, _MOST_MB)
    with open(path, "rb") as file:  # says whether it is there and may be read, which OpenCV does not
        if not file.read(1):
            raise ValueError(f"{path}: expected a video, got an empty file")
    # A pattern of numbered pictures is a name too to OpenCV's other backend.
    capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
    try:
        if not capture.isOpened():
            raise ValueError(f"{path}: expected a video, got a file that OpenCV cannot open as one")
        has_frame, frame = capture.read()
        if not has_frame:
            raise ValueError(f"{path}: expected a video with frames, got one of which none can be decoded")
        if not capture.read()[0]:
            raise ValueError(f"{path}: expected a video of several frames, got a single one")
        fps = float(capture.get(cv2.CAP_PROP_FPS))
    finally:
        capture.release()
    return Video(path, fps if 0 < fps < _MOST_FPS else _USUAL_FPS, (frame.shape[0], frame.shape[1]))
