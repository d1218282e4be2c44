"""A Wavefront OBJ file, its vertices in their order."""

import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo.arrays import Floats, Integers
from toongeo.reading.check_file import file_bytes
from toongeo.reading.decoded import decoded
from toongeo.reading.promise import promised

__all__ = ["ObjData", "read_obj"]

_MOST_MB = 256  # ten times a head of 300,000 vertices; the words of a text take many times its size
# Corners of all polygons, each counted as the largest: of a table of them, and how many for each that is there.
_FEW_CORNERS, _MOST_PADDING = 4 * 10**6, 8


@dataclass(frozen=True, eq=False)
class ObjData:
    """What an OBJ holds, as one mesh.

    Parameters
    ----------
    vertices
        (n, 3) in the file's unit and axes, in the file's order.
    faces
        (m, k) 0-based, k the most corners a polygon has; shorter ones end in -1.
    uv
        (t, 2), v up; (0, 2) if there are none.
    uv_faces
        (m, k) into ``uv``; -1 where a corner has none.
    objects
        Names by ``o`` or ``g``, in the file's order.
    face_object
        (m,) into ``objects``.
    """

    vertices: Floats
    faces: Integers
    uv: Floats
    uv_faces: Integers
    objects: tuple[str, ...]
    face_object: Integers

    __repr__ = brief_repr

    def triangles(self) -> tuple[Integers, Integers, Integers]:
        """Each polygon as a fan about its first corner.

        Returns
        -------
        faces : (p, 3)
            Into ``vertices``.
        uv_faces : (p, 3)
            Into ``uv``, -1 where there is none.
        polygon : (p,)
            Row of ``faces`` each triangle came from, ascending.
        """
        polygon, last = np.nonzero(self.faces[:, 2:] >= 0)
        corner = np.stack([np.zeros_like(last), last + 1, last + 2], axis=1)
        row = polygon[:, None]
        return self.faces[row, corner], self.uv_faces[row, corner], polygon


@promised("a Wavefront OBJ")
def read_obj(path: str | os.PathLike[str]) -> ObjData:
    """Read vertices, uv and polygons; normals, materials, curves and vertex colours are ignored.

    Unlike trimesh's reader it neither merges nor repeats vertices, so correspondence is kept.

    Parameters
    ----------
    path
        ``.obj`` file.

    Returns
    -------
    ObjData
        All objects as one mesh.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If a line cannot be understood (says which), an index is out of range, or there is no face.
    """
    # Bytes that are not UTF-8 occur in names and comments of old files, where they do no harm.
    content = file_bytes(path, _MOST_MB)
    text = decoded(content, "replace").replace("\r\n", "\n").replace("\r", "\n").replace("\\\n", " ")
    lines = text.splitlines()
    found = {"v": _Rows(3), "vt": _Rows(2), "f": _Rows(sys.maxsize)}
    named: list[int] = []
    names: list[str] = []
    for number, line in enumerate(lines):
        words = line.split()
        if "#" in line and words[0] in found:  # what stands behind it is for people
            words = line.partition("#")[0].split()
        keyword = words.pop(0) if words else ""
        if keyword in found:
            rows = found[keyword]
            del words[rows.most :]
            rows.at.append(number)
            rows.sizes.append(len(words))
            rows.words += words
        elif keyword in ("o", "g"):
            named.append(number)
            names.append(" ".join(words))
    polygons = found["f"]
    try:
        vertices, uv = _numbers(found["v"]), _numbers(found["vt"])
        faces, uv_faces = _polygons(polygons, found["v"].at, found["vt"].at)
    except _LineError as error:
        line = lines[error.line].strip()[:60]
        raise ValueError(f"path: line {error.line + 1} of {path} is {line!r}: {error}") from error
    if not len(faces):
        raise ValueError(f"path: expected an OBJ with faces, got none in {path}")
    face_object = np.searchsorted(named, polygons.at) - 1
    if face_object[0] < 0:  # faces before the first name
        names, face_object = ["", *names], face_object + 1
    return ObjData(vertices, faces, uv, uv_faces, tuple(names), face_object)


@dataclass
class _Rows:
    """All lines of one keyword: their numbers, how many words each has after it, and all these words in one list.

    Texts are turned into numbers all at once: a call for each line, or a list kept for each, takes twice as long.
    """

    most: int  # words that count; what follows them (a colour, a third coordinate of uv) is dropped
    at: list[int] = field(default_factory=list)
    sizes: list[int] = field(default_factory=list)
    words: list[str] = field(default_factory=list)


class _LineError(ValueError):
    """What is wrong with which line, 0-based."""

    def __init__(self, line: int, reason: object) -> None:
        super().__init__(str(reason))
        self.line = int(line)


def _numbers(rows: _Rows) -> Floats:
    """The numbers (n, most) of all lines."""
    short = np.array(rows.sizes, dtype=np.int64) != rows.most
    if short.any():
        raise _LineError(rows.at[short.argmax()], f"expected {rows.most} finite numbers")
    line = np.repeat(rows.at, rows.sizes)
    values = np.array(_each(float, rows.words, line, np.arange(len(line))), dtype=np.float64)
    finite = np.isfinite(values)
    if not finite.all():
        raise _LineError(line[finite.argmin()], f"expected {rows.most} finite numbers")
    return values.reshape(-1, rows.most)


def _polygons(rows: _Rows, vertices: list[int], uv: list[int]) -> tuple[Integers, Integers]:
    """Corners (m, k) into vertices and into uv, which stand in these lines; -1 where there is none."""
    sizes = np.array(rows.sizes, dtype=np.int64)
    if (sizes < 3).any():
        first = (sizes < 3).argmax()
        raise _LineError(rows.at[first], f"expected at least 3 corners, got {sizes[first]}")
    # A corner comes again in every polygon around it: each text is read once.
    texts = {text: k for k, text in enumerate(dict.fromkeys(rows.words))}
    corner = np.array([texts[word] for word in rows.words], dtype=np.int64)
    parts = [text.split("/", 2) for text in texts]
    largest = int(sizes.max(initial=3))
    if largest * len(sizes) > max(_FEW_CORNERS, _MOST_PADDING * sizes.sum()):
        raise _LineError(rows.at[sizes.argmax()], f"a polygon of {largest} corners among {len(sizes)} polygons")
    inside = np.arange(largest) < sizes[:, None]
    padded = np.full((2, *inside.shape), -1, dtype=np.int64)
    padded[0, inside] = _indices([part[0] for part in parts], corner, rows, vertices)
    padded[1, inside] = _indices([part[1] if any(part[1:2]) else None for part in parts], corner, rows, uv)
    return padded[0], padded[1]


def _indices(texts: Sequence[str | None], corner: Integers, rows: _Rows, elements: list[int]) -> Integers:
    """0-based index at every corner, of which `corner` tells the text; elements are the lines that it counts.

    -1 where there is none.
    """
    line = np.repeat(rows.at, rows.sizes)
    given = np.array(_each(_whole, ["1" if text is None else text for text in texts], line, corner))[corner]
    absent = np.array([text is None for text in texts], dtype=bool)[corner]
    so_far = np.searchsorted(elements, rows.at).repeat(rows.sizes)
    index = np.where(given > 0, given - 1, so_far + given)  # a negative number counts from the latest so far
    wrong = ~absent & ((given == 0) | (index < 0) | (index >= len(elements)))
    if wrong.any():
        first = wrong.argmax()
        raise _LineError(line[first], f"index {texts[corner[first]]} is out of range, {len(elements)} elements")
    return np.where(absent, -1, index).astype(np.int64)


def _whole(text: str) -> float:
    return float(int(text))  # exact as far as any file counts, and no number is too large for an array of them


def _each(number: Callable[[str], float], texts: list[str], line: Integers, place: Integers) -> list[float]:
    """Every text as a number; the words of the file stand in these lines, and `place` tells the text of each."""
    try:
        return list(map(number, texts))
    except (ValueError, OverflowError):
        for k, text in enumerate(texts):
            try:
                number(text)
            except (ValueError, OverflowError) as error:
                raise _LineError(line[(place == k).argmax()], error) from error
        raise
