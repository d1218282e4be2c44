"""Videos by OpenCV."""

from pathlib import Path

import cv2
import numpy as np

__all__ = ["OpencvEncoder"]

# By suffix: codecs that OpenCV's wheels have and browsers play. VP8 takes a sixth of the time of VP9, but may not stand
# in .mp4.
_CODES = {".mp4": "vp09", ".webm": "VP80"}


class OpencvEncoder:
    """Writes pictures of one size (height, width); silent.

    Raises
    ------
    OSError
        If OpenCV has no such encoder, or not all pictures are in the file in the end.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: float) -> None:
        self._path, self._written = path, 0
        code = cv2.VideoWriter.fourcc(*_CODES[path.suffix])  # of VP8 it says that WebM has no such codes, and writes it
        self._writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, code, fps, size[::-1])
        if not self._writer.isOpened():
            raise OSError("OpenCV has no encoder for VP9 and VP8 here")

    def add(self, frame: np.ndarray) -> None:
        """The next picture (H, W, 3) uint8 RGB."""
        self._writer.write(np.ascontiguousarray(frame[:, :, ::-1]))
        self._written += 1

    def finish(self) -> None:
        """Complete the file. The encoder does not report a full disk: the file tells."""
        self._writer.release()
        kept = max(0, int(cv2.VideoCapture(str(self._path)).get(cv2.CAP_PROP_FRAME_COUNT)))
        if kept != self._written or not kept:
            raise OSError(f"{kept} of {self._written} frames are in the file")

    def close(self) -> None:
        """Release the file, complete or not."""
        self._writer.release()
