"""Rings of vertices around the opening between the lids."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from toongeo._read_only import read_only, restored
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model import MorphableModel
from toongeo.model.anatomy.rims import opening_rim, rim_path

__all__ = ["LidRings", "lid_rings", "opening_height"]

_ROWS = 3  # from the inner edge of the lids' margin to the outer one, where the lashes grow


@dataclass(frozen=True, eq=False)
class LidRings:
    """The edges of the lids of one eye, in columns from corner to corner.

    Attributes
    ----------
    upper : (3, k) int64
        Vertices of the upper lid. Row 0 is the inner edge, where the socket begins, row 2 the outer edge; a column
        leads straight away from the opening. The first and the last column are the corners of the eye.
    lower : (3, m) int64
        The same of the lower lid; its corner columns are those of the upper lid.
    """

    upper: np.ndarray
    lower: np.ndarray

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "upper", "lower")

    @property
    def vertices(self) -> np.ndarray:
        """All of them, sorted, none twice."""
        return np.union1d(self.upper, self.lower)


def lids_of(side: str) -> tuple[str, ...]:
    """What a model must have for :func:`lid_rings` of the "left" or "right" eye."""
    return "quads", f"eye_{side}", f"socket_{side}"


@lru_cache(maxsize=8)
def lid_rings(model: MorphableModel, side: str) -> LidRings:
    """Rings of the lids of the "left" or "right" eye.

    Raises
    ------
    ValueError
        If the lids of the model are not rings of quads around the socket, or there is no such eye.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> rings = lid_rings(default_model(), "left")
    >>> rings.upper.shape[1] + rings.lower.shape[1] - 2  # the corners are in both
    56
    """
    rim = opening_rim(model, f"socket_{side}")
    neighbours: dict[int, set[int]] = {}
    near = model.region(f"eye_{side}") | model.region(f"socket_{side}")
    quads = model.quads[near[model.quads].all(1)]
    for edge in quads[:, [[0, 1], [1, 2], [2, 3], [3, 0]]].reshape(-1, 2):
        a, b = (int(v) for v in edge)
        neighbours.setdefault(a, set()).add(b)
        neighbours.setdefault(b, set()).add(a)
    rows = [_loop({v: sorted(neighbours.get(v, set()) & set(rim.tolist())) for v in rim.tolist()})]
    taken = set(np.flatnonzero(model.region(f"socket_{side}")).tolist()) | set(rim.tolist())
    while len(rows) < _ROWS:
        outwards = [neighbours.get(v, set()) - taken for v in rows[-1]]
        if len(rows[-1]) != len(rim) or any(len(found) != 1 for found in outwards):
            raise ValueError(f"model: expected {_ROWS} rings of quads around socket_{side}")
        rows.append([found.pop() for found in outwards])
        taken |= set(rows[-1])
    rings = np.array(rows)
    upper = rim_path(model, f"lid_upper_{side}")
    corners = [_nearest(model, rings, upper[end]) for end in (0, -1)]
    rings = np.roll(rings, -corners[0], axis=1)
    far = (corners[1] - corners[0]) % rings.shape[1]
    halves = rings[:, : far + 1], np.column_stack([rings[:, far:], rings[:, :1]])[:, ::-1]
    if np.isin(upper, halves[0]).sum() < np.isin(upper, halves[1]).sum():
        halves = halves[::-1]
    return LidRings(*(np.ascontiguousarray(half) for half in halves))


def opening_height(upper: np.ndarray, lower: np.ndarray) -> float:
    """Greatest distance of points at the same share of an upper (k, 3) and a lower rim (m, 3).

    Examples
    --------
    >>> opening_height(np.array([[-2.0, 0, 0], [0, 2, 0], [2, 0, 0]]), np.array([[-2.0, 0, 0], [0, -1, 0], [2, 0, 0]]))
    3.0
    """
    return float(np.linalg.norm(upper - interpolated(arc_shares(upper), arc_shares(lower), lower), axis=1).max())


def _loop(along: dict[int, list[int]]) -> list[int]:
    """The vertices of a cycle in order, from their neighbours on it; shorter than all of them if it is none."""
    start = min(along)
    loop, previous, here = [start], -1, start
    while len(loop) <= len(along):
        following = [v for v in along[here] if v != previous]
        if not following or following[0] == start:
            break
        previous, here = here, following[0]
        loop.append(here)
    return loop


def _nearest(model: MorphableModel, rings: np.ndarray, vertex: int) -> int:
    """Column of the rings that is nearest to a vertex."""
    distance = np.linalg.norm(model.mean[rings] - model.mean[vertex], axis=2)
    return int(distance.min(0).argmin())
