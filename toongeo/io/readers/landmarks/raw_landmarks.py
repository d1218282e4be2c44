"""What a reader of landmark files gives, before anyone asks which face and which scheme."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats

__all__ = ["RawLandmarks", "face_points"]


@dataclass(frozen=True, eq=False)
class RawLandmarks:
    """All faces of a file.

    Parameters
    ----------
    format
        Name of the format, for people.
    frames
        Of each frame (or picture) the faces, each (k, 2): x right, y down, 0-based, in px or shares of the picture.
        Missing points are NaN rows.
    axes_doubtful
        Whether some programs exchange x and y in files of this format.
    """

    format: str
    frames: tuple[tuple[Floats, ...], ...]
    axes_doubtful: bool = False


def face_points(rows: Iterable[Iterable[float]] | Floats, shift: int = 0) -> Floats:
    """Points (k, 2) less ``shift`` out of rows of x, y and perhaps a depth or a score.

    A row of three zeros is a point that was not found: so COCO and OpenPose have it. So is one of -1 alone, which lies
    in no picture.
    """
    points = np.array(rows if isinstance(rows, np.ndarray) else list(map(list, rows)), np.float64)
    points = points.reshape(len(points), -1) if points.size else np.empty((0, 2))
    if points.shape[1] == 3:
        points[(points == 0).all(axis=1)] = np.nan
    points[(points == -1).all(axis=1)] = np.nan
    return points[:, :2] - shift
