"""Checked sequences of landmarks."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks

__all__ = ["landmark_frames"]


def landmark_frames(recording: Any, name: str = "recording", scheme: str = "ibug68") -> NDArray[np.float64]:
    """Landmarks (f, 68, 2) px as float64; those of one frame may come as (68, 2).

    With another scheme than iBUG-68 the frames have its points: see :func:`toongeo.ibug_landmarks`.

    Raises
    ------
    ValueError
        If they are not numbers, have another shape, or hold infinities; NaN, or what a masked array hides, is missing.

    Examples
    --------
    >>> landmark_frames(np.zeros((68, 2))).shape
    (1, 68, 2)
    """
    try:
        frames = np.array(np.ma.filled(np.ma.asanyarray(recording, np.float64), np.nan))
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected numbers (frames, 68, 2), got {type(recording).__name__}") from None
    if frames.ndim == 2:
        frames = frames[None]
    if scheme != "ibug68" and frames.ndim == 3:
        frames = np.stack([ibug_landmarks(frame, scheme) for frame in frames])
    if frames.ndim != 3 or frames.shape[1:] != (68, 2) or not len(frames):
        raise ValueError(f"{name}: expected shape (frames, 68, 2), got {frames.shape}")
    if np.isinf(frames).any():
        raise ValueError(f"{name}: expected finite px, or NaN for missing points, got infinity")
    frames[np.isnan(frames).any(axis=2)] = np.nan
    return frames
