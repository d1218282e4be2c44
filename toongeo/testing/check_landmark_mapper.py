"""Whether something is a `LandmarkMapper`."""

from __future__ import annotations

import numpy as np

from toongeo.protocols import LandmarkMapper
from toongeo.testing.example import example, require, unchanged

__all__ = ["check_landmark_mapper"]


def check_landmark_mapper(mapper: LandmarkMapper, *, tolerance: float = 0.5) -> None:
    """Take landmarks to a normal face and back.

    Parameters
    ----------
    mapper : LandmarkMapper
    tolerance : float, px
        Of the way there and back.

    Raises
    ------
    AssertionError
        If the normal face misses points, the way back does not lead to the drawing, a moved normal face moves no
        drawing, or landmarks are written to.

    Examples
    --------
    >>> from toongeo import PartMapper
    >>> check_landmark_mapper(PartMapper())
    """
    points = np.array(example()[1])
    holes = points.copy()
    holes[[2, 40]] = np.nan
    for landmarks in (points, holes):
        before = landmarks.copy()
        normal, context = mapper.to_normal(landmarks)
        unchanged("landmarks", before, landmarks)
        complete = np.shape(normal) == (68, 2) and np.isfinite(normal).all()
        require(complete, f"to_normal: expected all of (68, 2), got shape {np.shape(normal)} or NaN")
        back = mapper.to_caricature(normal, context)
        require(np.shape(back) == (68, 2), f"to_caricature: expected (68, 2), got {np.shape(back)}")
        known = np.isfinite(landmarks).all(axis=1)
        off = np.linalg.norm(np.asarray(back)[known] - landmarks[known], axis=1).max()
        require(off <= tolerance, f"to_caricature: expected the drawing back within {tolerance} px, got {off:.2f}")
    moved = np.array(normal)
    moved[57] += [0.0, 10.0]
    require(not np.array_equal(mapper.to_caricature(moved, context), back), "to_caricature: expected a lip to move")
