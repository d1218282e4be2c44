"""Landmarks of iBUG and menpo: ``.pts``."""

from pathlib import Path

from toongeo.io.readers.landmarks.file_contents import file_lines
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks
from toongeo.io.readers.landmarks.read_rows import points_of_lines

__all__ = ["read_pts"]


def read_pts(path: Path, shift: int = 1) -> RawLandmarks:
    """Points between ``{`` and ``}``, 1-based as 300-W and menpo write them.

    Raises
    ------
    ValueError, OSError
        If the braces are missing, the number announced is another, or a line is no point.
    """
    lines = file_lines(path)
    marks = [k for k, (_, line) in enumerate(lines) if line.strip() in ("{", "}")]
    if len(marks) != 2 or [lines[k][1].strip() for k in marks] != ["{", "}"]:
        raise ValueError(f"path: expected one '{{' and one '}}' around the points of a .pts file, but not in {path}")
    body = lines[marks[0] + 1 : marks[1]]
    for _, line in lines[: marks[0]]:
        key, _, value = line.partition(":")
        if key.strip() == "n_points" and value.strip() != str(len(body)):
            raise ValueError(f"path: {path} announces n_points: {value.strip()[:20]}, but holds {len(body)}")
    return RawLandmarks("iBUG .pts", ((points_of_lines(body, path, shift),),))
