"""Points of a part in another order than iBUG's: sides or edges exchanged, a row that runs backwards."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.io.landmarks.frontal_layout import frontal_layout

__all__ = ["order_doubts"]


# First and last point of each row, its part in the layout, its name.
_ROWS = (
    (17, 21, "brows", "right brow"),
    (22, 26, "brows", "left brow"),
    (27, 30, "bridge", "bridge of the nose"),
    (31, 35, "nostrils", "base of the nose"),
    (49, 53, "outer lips", "upper lip"),
    (55, 59, "outer lips", "lower lip"),
    (61, 63, "inner lips", "inner edge of the upper lip"),
    (65, 67, "inner lips", "inner edge of the lower lip"),
)
# Points of the upper edge and those below them, and the name.
_EDGES = (
    ((37, 38), (41, 40), "right eye"),
    ((43, 44), (47, 46), "left eye"),
    ((49, 50, 51, 52, 53), (59, 58, 57, 56, 55), "outer lips"),
    ((61, 62, 63), (67, 66, 65), "inner lips"),
)
# A row in order has up to 1, reversed minus that; the least that a row in order has in examples/portraits is 0.65.
_BACKWARDS = -0.3
# Height of an opening over its width. Closed lids and lips cross in annotations too, by 0.03 at most in those seen.
_CROSSED = -0.08


def order_doubts(points: Floats, pose: Floats) -> list[str]:
    """Sentences about parts (68, 2) that look right only in another order.

    Parameters
    ----------
    points
        (68, 2) px, NaN rows are missing.
    pose
        (2, 2), the rotation layout -> points, as of :func:`frontal_pose`.
    """
    upright = points @ pose  # the face's own axes: x towards the subject's left, y down
    along, possible = _along(upright)
    backwards = [row for row in _ROWS if along[row[0] : row[1]].sum() < _BACKWARDS * possible[row[0] : row[1]].sum()]
    doubts = []
    for part in _exchanged_parts(upright):
        all_rows, turned = (sum(row[2] == part for row in some) for some in (_ROWS, backwards))
        if turned in (0, all_rows):  # otherwise it is the row that is wrong, and not the part
            backwards = [row for row in backwards if row[2] != part]
            doubts.append(f"landmarks of the {part}: left and right seem to be exchanged")
    doubts += [f"points {first}-{last} run backwards ({name})" for first, last, _, name in backwards]
    for upper, lower, name in _EDGES:
        height = (upright[list(lower), 1] - upright[list(upper), 1]).tolist()
        rows = [*upper, *lower]
        width = np.ptp(upright[rows, 0]) if np.isfinite(upright[rows]).all() else np.nan
        if np.mean(height) < _CROSSED * width:
            doubts.append(f"landmarks of the {name}: upper and lower points seem to be exchanged")
    return doubts


def _along(upright: Floats) -> tuple[Floats, Floats]:
    """How far (67,) each point is from the one before it along the layout's step, and how far it could be.

    Both are zero where one of the two is missing.
    """
    steps, expected = (shape[1:] - shape[:-1] for shape in (upright, frontal_layout().points))
    steps[np.isnan(steps)] = 0.0
    possible = np.linalg.norm(steps, axis=1) * np.linalg.norm(expected, axis=1)
    return np.einsum("ij,ij->i", steps, expected), possible


def _exchanged_parts(upright: Floats) -> list[str]:
    layout = frontal_layout()
    # Towards the subject's left: negative in a part whose sides are exchanged.
    sideways = np.sign(layout.points[:, 0]) * (upright - upright[layout.mirror])[:, 0]
    sideways[np.isnan(sideways)] = 0.0
    names, part_of = _parts()
    sums = np.bincount(part_of, sideways)
    return [part for part, total in zip(names, sums, strict=True) if total < 0]


@cache
def _parts() -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Names of the layout's parts, and the part (68,) of each point."""
    names = tuple(dict.fromkeys(frontal_layout().parts))
    return names, np.array([names.index(part) for part in frontal_layout().parts])
