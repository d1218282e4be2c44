"""Where a patch of skin passes through itself.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

from typing import NamedTuple, Protocol

import numpy as np

from toongeo.geometry import self_intersections
from toongeo.model import MorphableModel
from toongeo.pipeline.rig.skin.neighbour_means import neighbour_means

__all__ = ["HOPELESS", "Sheet", "SkinPatch", "around", "crossing_all", "crossing_triangles", "resolve_crossings"]

_ROUNDS = 5  # of looking for crossings and smoothing
_WIDTH = 4  # edges around them within which ways are smoothed
HOPELESS = 0.25  # of the triangles: where more cross, skin is crumpled beyond what any of this can mend
_PASSES = 3  # of smoothing a round


class SkinPatch(Protocol):
    """Vertices (k,) of a head, and triangles (m, 3) among them, by their place in ``vertices``."""

    @property
    def vertices(self) -> np.ndarray: ...

    @property
    def faces(self) -> np.ndarray: ...


class Sheet(NamedTuple):
    """Vertices (n, 3) of a head, and the triangles (k,) of a patch of it that are looked at."""

    V: np.ndarray
    triangles: np.ndarray


def crossing_triangles(patch: SkinPatch, sheets: list[Sheet]) -> list[np.ndarray]:
    """Of each sheet, the triangles that intersect others of it, as rows of ``patch.faces``.

    All sheets are laid side by side and looked at as one mesh, which is much faster than one after the other.
    """
    if not sheets:
        return []
    points = [sheet.V[patch.vertices] for sheet in sheets]
    apart = 2 * max(float(np.ptp(P[:, 0])) for P in points)
    side_by_side = np.vstack([P + [k * apart, 0, 0] for k, P in enumerate(points)])
    owner = np.repeat(np.arange(len(sheets)), [len(sheet.triangles) for sheet in sheets])
    triangles = np.concatenate([sheet.triangles for sheet in sheets])
    F = patch.faces[triangles] + len(patch.vertices) * owner[:, None]
    hit = np.unique(self_intersections(side_by_side, F))
    return [triangles[hit[owner[hit] == k]] for k in range(len(sheets))]


def crossing_all(patch: SkinPatch, V: np.ndarray) -> np.ndarray:
    """The triangles of a patch that intersect others of it in a head V (n, 3)."""
    return crossing_triangles(patch, [Sheet(V, np.arange(len(patch.faces)))])[0]


def resolve_crossings(
    model: MorphableModel, patch: SkinPatch, start: np.ndarray, ways: np.ndarray, allowed: int
) -> np.ndarray:
    """Ways (n, 3) from ``start`` (n, 3), made alike where they lead triangles of a patch through each other.

    Neighbours that go the same way cannot meet. What crosses at the start may go on, and so many others as are
    ``allowed``.
    """
    best, least, known = ways, np.inf, None
    for _ in range(_ROUNDS):
        hit = crossing_all(patch, start + ways)
        if len(hit) > HOPELESS * len(patch.faces):
            break
        if len(hit) > allowed:
            known = crossing_all(patch, start) if known is None else known
            hit = np.setdiff1d(hit, known)
        if len(hit) < least:
            best, least = ways, len(hit)
        if least <= allowed:
            break
        weight = around(model, patch.vertices[patch.faces[hit]], _WIDTH)[:, None]
        ways = ways.copy()
        for _ in range(_PASSES):
            ways += weight * (neighbour_means(model) @ ways - ways)
    return best


def around(model: MorphableModel, vertices: np.ndarray, steps: int) -> np.ndarray:
    """Weights (n,): 1 at vertices, less and less around them, zero beyond so many steps."""
    weight = np.zeros(len(model.mean))
    weight[vertices] = 1
    means = neighbour_means(model)
    for _ in range(steps):
        weight = np.maximum(weight, means @ weight)
    return weight
