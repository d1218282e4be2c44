"""A take of landmarks from a file: a face through all frames."""

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.readers.landmarks.landmark_readers import raw_landmarks
from toongeo.io.readers.landmarks.placed_landmarks import PictureSize, placed_landmarks
from toongeo.reading.promise import promised

__all__ = ["read_landmark_frames"]


@promised("landmarks")
def read_landmark_frames(
    path: str | os.PathLike[str],
    *,
    scheme: str = "auto",
    face: int = 0,
    size: PictureSize | None = None,
    one_based: bool | None = None,
) -> NDArray[np.float64]:
    """The landmarks (f, 68, 2) px of one face in all frames of a file.

    Parameters
    ----------
    path, scheme, face, size, one_based
        As of :func:`read_landmark_file`; an ``.npy`` may be (frames, points, 2 or 3) here. With ``scheme="auto"`` all
        frames have the scheme of the first.

    Returns
    -------
    (f, 68, 2) float64
        Frames without that face are NaN.

    Raises
    ------
    OSError, ValueError
        As of :func:`read_landmark_file`, and if no frame has that face.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "take.npy"
    >>> np.save(path, np.ones((24, 68, 2)) + np.arange(68)[:, None])
    >>> read_landmark_frames(path).shape
    (24, 68, 2)
    """
    path = Path(path)
    raw = raw_landmarks(path, scheme, one_based)
    frames = raw.frames
    if raw.format == "NumPy" and len(frames) == 1:  # which cannot tell the faces of a picture from frames
        frames = tuple((points,) for points in frames[0])
    if isinstance(face, bool) or not isinstance(face, int | np.integer) or face < 0:
        raise ValueError(f"face: expected an integer >= 0, got {face!r}")
    found = np.full((len(frames), 68, 2), np.nan)
    for k, faces in enumerate(frames):
        if face < len(faces) and np.isfinite(faces[face]).any():
            placed = placed_landmarks(faces[face], path, scheme=scheme, size=size, axes_doubtful=raw.axes_doubtful)
            found[k], scheme = placed.points, placed.scheme
    if np.isnan(found).all():
        raise ValueError(f"face: expected one that is in {path}, but {face} is in none of its {len(frames)} frames")
    return found
