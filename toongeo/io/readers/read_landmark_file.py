"""Landmark files of all formats into 68 pixels, with what was found in them."""

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo._read_only import read_only
from toongeo.io.landmarks.frontal_layout import frontal_layout, frontal_pose
from toongeo.io.landmarks.landmark_schemes import SCHEMES, ibug_points, scheme_of
from toongeo.io.readers.landmarks.landmark_readers import LANDMARK_READERS
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks

__all__ = ["LandmarkFile", "PictureSize", "read_landmark_file"]

PictureSize = tuple[int, int] | NDArray[np.uint8]

# Shares of a picture lie in 0..1, and a little beyond for faces at its edge; a face in pixels is larger.
_LARGEST_SHARE = 2.0
# How much better a face with x and y exchanged must be, as in check_landmarks.
_HANDEDNESS_MARGIN = 0.1


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
    """

    points: NDArray[np.float64]
    scheme: str
    format: str
    frame: int
    face: int
    frames: int
    faces: int
    message: str

    def __post_init__(self) -> None:
        read_only(self, "points")


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
    reader = LANDMARK_READERS.get(path.suffix.lower())
    if reader is None:
        raise ValueError(f"path: expected {_listed(LANDMARK_READERS)}, got {path}")
    if scheme != "auto" and scheme not in SCHEMES:
        raise ValueError(f"scheme: expected 'auto' or one of {', '.join(map(repr, SCHEMES))}, got {scheme!r}")
    raw = reader.read(path, int(reader.one_based if one_based is None else one_based))
    frame = _frame(raw, frame, path)
    faces = raw.frames[frame]
    points, notes = _pixels(faces[_index(face, len(faces), "face", path)], size, path)
    name = f"landmarks in {path}"
    used = scheme_of(points, name) if scheme == "auto" else scheme
    landmarks = ibug_points(points, used, name)
    if raw.axes_doubtful and _columns_exchanged(landmarks):
        landmarks = landmarks[:, ::-1].copy()
        notes += "; as (x, y), in which they form a face, and not as (y, x)"
    found = LandmarkFile(landmarks, used, raw.format, frame, face, len(raw.frames), len(faces), "")
    return replace(found, message=_message(found, path, scheme, len(points)) + notes)


def _listed(names: object) -> str:
    *most, last = list(names)  # type: ignore[call-overload]
    return f"{', '.join(most)} or {last}"


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


def _pixels(points: NDArray[np.float64], size: PictureSize | None, path: Path) -> tuple[NDArray[np.float64], str]:
    """Points in pixels, and a note if they were shares of the picture."""
    finite = points[np.isfinite(points).all(axis=1)]
    if not len(finite) or np.abs(finite).max() > _LARGEST_SHARE:
        return points, ""
    if size is None:
        if len(points) in SCHEMES["mediapipe478"]:
            raise ValueError(f"size: landmarks in {path} are shares of the picture; expected its (width, height)")
        return points, ""
    width, height = _width_and_height(size)
    return points * [width, height] - 0.5, f"; shares of a picture of {width} x {height} px"


def _width_and_height(size: PictureSize) -> tuple[int, int]:
    if isinstance(size, np.ndarray) and size.ndim in (2, 3):
        size = (size.shape[1], size.shape[0])
    try:
        width, height = (int(n) for n in size)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"size: expected (width, height) px or a picture, got {size!r}") from None
    if min(width, height) < 1:
        raise ValueError(f"size: expected (width, height) > 0 px, got {size!r}")
    return width, height


def _columns_exchanged(points: NDArray[np.float64]) -> bool:
    usable = np.isfinite(points[:, 0])
    if not np.ptp(points[usable], axis=0).any():
        return False
    _, misfit, mirrored = frontal_pose(points[usable], frontal_layout().points[usable])
    return mirrored < misfit - _HANDEDNESS_MARGIN


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
