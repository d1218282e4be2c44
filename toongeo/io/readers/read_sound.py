"""A sound file as numbers."""

import os
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io.wavfile
from numpy.typing import NDArray

from toongeo.io.pyav_adapter import load_pyav
from toongeo.reading.promise import promised

__all__ = ["read_sound"]


@promised("a sound")
def read_sound(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], float]:
    """Samples (n,), -1 to 1, the mean of all channels, and their rate in Hz.

    Parameters
    ----------
    path
        ``.wav``; with PyAV (extra ``video``) anything that has a sound, films too.

    Raises
    ------
    OSError
        If the file cannot be read.
    ImportError
        If it is no ``.wav`` and PyAV is not installed.
    ValueError
        If it holds no sound.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "a.wav"
    >>> scipy.io.wavfile.write(path, 8000, np.array([0, 16384, -32768], np.int16))
    >>> read_sound(path)
    (array([ 0. ,  0.5, -1. ]), 8000.0)
    """
    path = Path(path)
    with open(path, "rb") as file:
        head = file.read(12)
    if head[:4] in (b"RIFF", b"RIFX", b"RF64") and head[8:12] == b"WAVE":
        return _wave(path)
    return _decoded(path)


def _wave(path: Path) -> tuple[NDArray[np.float64], float]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", scipy.io.wavfile.WavFileWarning)  # of chunks with titles and the like
            rate, samples = scipy.io.wavfile.read(path)
    except (ValueError, EOFError, ArithmeticError, LookupError, TypeError, struct.error) as error:
        raise ValueError(f"{path}: expected a sound, got a damaged .wav ({error})") from None
    if not len(samples):
        raise ValueError(f"{path}: expected a sound, got an empty one")
    numbers = samples.astype(np.float64)
    if samples.dtype.kind in "iu":
        half = 2.0 ** (8 * samples.dtype.itemsize - 1)
        numbers = numbers / half - (1.0 if samples.dtype.kind == "u" else 0.0)
    return (numbers if numbers.ndim == 1 else numbers.mean(axis=1)), float(rate)


def _decoded(path: Path) -> tuple[NDArray[np.float64], float]:
    av = load_pyav(f"a sound that is no .wav, as {path.name},")
    pieces: list[NDArray[Any]] = []
    try:
        with av.open(str(path)) as file:
            if not file.streams.audio:
                raise ValueError(f"{path}: expected a file with a sound, got one without")
            rate = file.streams.audio[0].rate
            mono = av.AudioResampler(format="flt", layout="mono", rate=rate)
            for decoded in (*file.decode(audio=0), None):
                pieces += [piece.to_ndarray()[0] for piece in mono.resample(decoded)]
    except av.FFmpegError as error:
        raise ValueError(f"{path}: expected a sound, got a file that cannot be decoded ({error})") from None
    if not pieces:
        raise ValueError(f"{path}: expected a sound, got an empty one")
    return np.concatenate(pieces).astype(np.float64), float(rate)
