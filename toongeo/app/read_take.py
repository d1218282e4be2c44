"""Takes from files."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.driving import ArkitDriver, LandmarkDriver, Take
from toongeo.io import read_landmark_frames
from toongeo.model.expression_schemes import EXPRESSIONS

__all__ = ["read_landmark_take", "read_take"]


def read_take(path: Path, fps: float | None = None) -> Take:
    """A take of weights: a Live Link Face ``.csv``, or an ``.npy`` of (f, 52) ARKit weights or (f, 54) of ours.

    Raises
    ------
    OSError, ValueError
        If the file cannot be read or is not one of these; says what is wrong where.
    """
    suffix = path.suffix.lower()
    if suffix == ".csv":
        return ArkitDriver().take(path, fps)
    if suffix != ".npy":
        raise ValueError(f"weights: expected a .csv or .npy file, got {path}")
    frames = _array(path)
    if frames.ndim == 2 and frames.shape[1] == len(EXPRESSIONS):
        return Take.of_frames(frames, fps or 30.0)
    return ArkitDriver().take(frames, fps or 30.0)


def read_landmark_take(path: Path, fps: float | None = None, *, scheme: str = "auto") -> Take:
    """A take from landmarks in px of each frame, the first of which shows the neutral face.

    Raises
    ------
    OSError, ValueError
        As of :func:`toongeo.io.read_landmark_frames`.
    """
    frames = read_landmark_frames(path, scheme=scheme)
    neutral = frames[np.isfinite(frames).any(axis=(1, 2))][0]
    weights = LandmarkDriver(neutral).frames(frames, fps or 30.0)
    return Take.of_frames(weights, fps or 30.0)


def _array(path: Path) -> NDArray[np.float64]:
    try:
        return np.asarray(np.load(path, allow_pickle=False), np.float64)
    except (ValueError, EOFError, TypeError) as error:
        raise ValueError(f"{path}: expected an array of numbers in NumPy's format ({error})") from None
