"""Pictures as a video."""

import errno
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from tqdm import tqdm

from toongeo.app.video.opencv_encoder import OpencvEncoder
from toongeo.app.video.pyav_encoder import PyavEncoder
from toongeo.app.video.sound import Sound
from toongeo.io import has_pyav
from toongeo.render.picture_size import picture_size

__all__ = ["VIDEO_SUFFIXES", "check_video", "write_video"]

VIDEO_SUFFIXES = (".mp4", ".webm")
_SAMPLES = 2  # a side of each pixel that are drawn


def write_video(
    path: Path,
    frames: Iterable[np.ndarray],
    size: int | tuple[int, int],
    fps: float,
    count: int | None = None,
    *,
    sound: Sound | None = None,
) -> None:
    """Write pictures (H, W, 3) uint8 RGB as a video that browsers play; the file is complete or not there.

    With PyAV (extra ``video``) an ``.mp4`` has H.264 and AAC, a ``.webm`` VP8 and Opus. Without it OpenCV writes VP9
    into ``.mp4`` and VP8 into ``.webm``, and there is no sound.

    Parameters
    ----------
    path : Path
        ``.mp4`` or ``.webm``.
    frames : iterable of pictures
    size : int or (int, int)
        Side, or height and width; even, at least 16: the codecs have no other.
    fps : float
    count : int, optional
        How many there will be, for the progress line.
    sound : Sound, optional
        Needs PyAV.

    Raises
    ------
    OSError
        If it cannot be written, or this OpenCV has no encoder.
    ImportError
        If there is a sound, but no PyAV.
    ValueError
        If suffix, size or rate cannot be, or a picture has another shape.
    """
    height, width = check_video(path, size, fps)
    if sound is not None and not has_pyav():
        raise ImportError('sound in a video needs PyAV: pip install "toongeo[video]"')
    try:
        folder = tempfile.TemporaryDirectory(dir=path.parent, prefix=".toongeo-")
    except OSError as error:
        raise OSError(error.errno, f"cannot write {path}: {error.strerror}") from error
    with folder:
        draft = Path(folder.name) / f"draft{path.suffix.lower()}"
        encoder: OpencvEncoder | PyavEncoder
        if has_pyav():
            encoder = PyavEncoder(draft, (height, width), fps, sound)
        else:
            encoder = OpencvEncoder(draft, (height, width), fps)
        try:
            for frame in tqdm(frames, total=count, unit="frame"):
                if frame.shape != (height, width, 3) or frame.dtype != np.uint8:
                    raise ValueError(f"frames: expected ({height}, {width}, 3) uint8, got {frame.shape} {frame.dtype}")
                encoder.add(frame)
            encoder.finish()
        except OSError as error:
            raise OSError(error.errno, f"cannot write {path}: {error}") from error
        finally:
            encoder.close()
        os.replace(draft, path)


def check_video(path: Path, size: int | tuple[int, int], fps: float) -> tuple[int, int]:
    """Height and width; refuses, before the work, what :func:`write_video` would."""
    height, width = (size, size) if isinstance(size, int) else size
    if path.suffix.lower() not in VIDEO_SUFFIXES:
        raise ValueError(f"output: expected a name that ends in {', '.join(VIDEO_SUFFIXES)}, got {path}")
    if min(height, width) < 16 or height % 2 or width % 2:
        raise ValueError(f"size: expected an even number of px, at least 16, got {size}")
    picture_size((height, width), _SAMPLES)
    if not (np.isfinite(fps) and 1 <= fps <= 240):
        raise ValueError(f"fps: expected 1 to 240 frames a second, got {fps}")
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, f"cannot write {path}: it is a folder")
    return height, width
