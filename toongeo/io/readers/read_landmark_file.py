"""Landmark files of all formats into 68 pixels, with what was found in them."""

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.io.landmarks.landmark_schemes import SCHEMES
from toongeo.io.readers.landmarks.landmark_readers import raw_landmarks
from toongeo.io.readers.landmarks.placed_landmarks import PictureSize, placed_landmarks
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks
from toongeo.reading.promise import promised

__all__ = ["LandmarkFile", "read_landmark_file"]


@dataclass(frozen=True, eq=False)
class LandmarkFile:
    """What was found in a landmark file.

    Parameters
    ----------
    points
        (68, 2) px in iBUG order, 0-based; missing points are NaN rows.
    scheme, format
        Of the points in the file, one of :data:`toongeo.io.SCHEMES`; and the name of the format.
    frame, face
        Which were taken, counted from 0 in the order of the file.
    frames, faces
        How many the file holds; faces: in that frame.
    message
        All of this in a sentence for people, and what was guessed.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> file = tg.read_landmark_file(data_path("examples/portraits/moustache_man.pts"))
    >>> file.points.shape, file.scheme, file.frames
    ((68, 2), 'ibug68', 1)
    """

    points: NDArray[np.float64]
    scheme: str
    format: str
    frame: int
    face: int
    frames: int
    faces: int
    message: str

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "points")


@promised("landmarks")
def read_landmark_file(
    path: str | os.PathLike[str],
    *,
    scheme: str = "auto",
    face: int = 0,
    frame: int | None = None,
    size: PictureSize | None = None,
    one_based: bool | None = None,
) -> LandmarkFile:
    """Read landmarks as any of the usual programs writes them; see `docs/landmarks.md` for the formats.

    Parameters
    ----------
    path
        ``.pts .txt .csv .npy .json .ljson .xml``; the end of the name says the format.
    scheme
        Of the points in the file, one of :data:`toongeo.io.SCHEMES`; ``"auto"``: by their number, and of several with
        this number the one in which they form a face.
    face, frame
        Which of several, counted from 0 in the order of the file. ``frame`` None: the first that has a face.
    size
        (width, height) of the picture, or the picture itself: needed for shares of the picture, as MediaPipe gives
        them; the middle of the first pixel is 0.
    one_based
        Whether 1 must be subtracted; None: as the format has it (``.pts``).

    Returns
    -------
    LandmarkFile

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it is damaged or of an unknown format or scheme, has no such face or frame, or holds shares and no size is
        given; names the file. The order and the place of the points are for :func:`check_landmarks`.

    Examples
    --------
    >>> import json, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "faces.json"
    >>> _ = path.write_text(json.dumps({"faceLandmarks": 2 * [478 * [{"x": 0.25, "y": 0.5, "z": 0}]]}))
    >>> found = read_landmark_file(path, face=1, size=(400, 300))
    >>> found.points[0], found.scheme, found.faces
    (array([ 99.5, 149.5]), 'mediapipe478', 2)
    """
    path = Path(path)
    raw = raw_landmarks(path, scheme, one_based)
    frame = _frame(raw, frame, path)
    faces = raw.frames[frame]
    points = faces[_index(face, len(faces), "face", path)]
    placed = placed_landmarks(points, path, scheme=scheme, size=size, axes_doubtful=raw.axes_doubtful)
    found = LandmarkFile(placed.points, placed.scheme, raw.format, frame, int(face), len(raw.frames), len(faces), "")
    return replace(found, message=_message(found, path, scheme, len(points)) + placed.notes)


def _frame(raw: RawLandmarks, frame: int | None, path: Path) -> int:
    if frame is not None:
        frame = _index(frame, len(raw.frames), "frame", path)
        if not raw.frames[frame]:
            raise ValueError(f"frame: expected one with a face, but {frame} has none in {path}")
        return frame
    for k, faces in enumerate(raw.frames):
        if faces:
            return k
    raise ValueError(f"path: expected a face, but there is none in {path}")


def _index(wanted: int, count: int, name: str, path: Path) -> int:
    if isinstance(wanted, bool) or not isinstance(wanted, int | np.integer) or not 0 <= wanted < count:
        raise ValueError(f"{name}: expected 0..{count - 1} for {path}, got {wanted!r}")
    return int(wanted)


def _message(found: LandmarkFile, path: Path, asked: str, count: int) -> str:
    where = [
        f"{name} {k} of {total}"
        for name, k, total in (("face", found.face, found.faces), ("frame", found.frame, found.frames))
        if total > 1
    ]
    guess = " (told by their number)" if asked == "auto" and found.scheme != "ibug68" else ""
    if asked == "auto" and sum(count in counts for counts in SCHEMES.values()) > 1:
        guess = " (of the schemes with this number the one that forms a face)"
    return ", ".join([f"{path}: {found.format}, {count} points, {found.scheme}{guess}", *where])
