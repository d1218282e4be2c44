"""Pictures as a video."""

import errno
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np
from tqdm import tqdm

__all__ = ["write_video"]


def write_video(path: Path, frames: Iterable[np.ndarray], size: int, fps: float, count: int | None = None) -> None:
    """Write pictures (size, size, 3) uint8 RGB as MPEG-4 (``mp4v``) with OpenCV; the file is complete or not there.

    Parameters
    ----------
    path : Path
    frames : iterable of pictures
    size : int
        Even, at least 16: the codec has no other.
    fps : float
    count : int, optional
        How many there will be, for the progress line.

    Raises
    ------
    OSError
        If it cannot be written, or this OpenCV has no encoder.
    ValueError
        If the size or the rate cannot be, or a picture has another shape.
    """
    if size < 16 or size % 2:
        raise ValueError(f"size: expected an even number of px, at least 16, got {size}")
    if not (np.isfinite(fps) and 1 <= fps <= 240):
        raise ValueError(f"fps: expected 1 to 240 frames a second, got {fps}")
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, f"cannot write {path}: it is a folder")
    try:
        folder = tempfile.TemporaryDirectory(dir=path.parent, prefix=".toongeo-")
    except OSError as error:
        raise OSError(error.errno, f"cannot write {path}: {error.strerror}") from error
    with folder:
        draft = Path(folder.name) / "draft.mp4"
        writer = cv2.VideoWriter(str(draft), cv2.VideoWriter.fourcc(*"mp4v"), fps, (size, size))
        if not writer.isOpened():
            raise OSError(f"cannot write {path}: OpenCV has no MPEG-4 encoder here")
        written = 0
        try:
            for frame in tqdm(frames, total=count, unit="frame"):
                if frame.shape != (size, size, 3) or frame.dtype != np.uint8:
                    raise ValueError(f"frames: expected ({size}, {size}, 3) uint8, got {frame.shape} {frame.dtype}")
                writer.write(np.ascontiguousarray(frame[:, :, ::-1]))
                written += 1
        finally:
            writer.release()
        # The encoder does not report a full disk: the file tells.
        kept = max(0, int(cv2.VideoCapture(str(draft)).get(cv2.CAP_PROP_FRAME_COUNT)))
        if kept != written or not kept:
            raise OSError(f"cannot write {path}: {kept} of {written} frames are in the file")
        os.replace(draft, path)
