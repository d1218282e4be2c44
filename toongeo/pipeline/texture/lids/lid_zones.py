"""Which skin only a closing eye shows.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import numpy as np
import scipy.sparse as sp

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lid_rings import lid_rings, lids_of
from toongeo.pipeline.rig.rig import Rig

__all__ = ["GROWTH", "lid_zone", "skin_edges"]

# Growth of a triangle's area in a blink: skin that grows less keeps its drawing, what grows more is new.
GROWTH = (1.3, 2.2)
_SOFTEN = 3  # passes over the border of the zone


def skin_edges(model: MorphableModel) -> sp.csr_array:
    """Edges (n, n) of the front skin."""
    return adjacency(model.faces[model.region("face")[model.faces].all(1)], len(model.mean)).astype(float).tocsr()


def lid_zone(
    model: MorphableModel, rig: Rig, side: str, edges: sp.csr_array, limits: tuple[float, float] = GROWTH
) -> np.ndarray | None:
    """How far (n,) in [0, 1] each vertex is skin that only shows when the "left" or "right" eye closes.

    1 on the upper lid's margin, 0 on the brow; None of a model or rig without such a lid. The limits are the growth of
    a triangle's area from which it counts, and from which wholly.
    """
    blink = f"eyeBlink{side.capitalize()}"
    if not model.has(*lids_of(side)) or blink not in rig.names:
        return None
    around = model.region(f"eye_{side}") & ~model.region(f"socket_{side}")
    if model.has(f"brow_{side}"):
        around &= ~model.region(f"brow_{side}")
    triangles = model.faces[around[model.faces].all(1)]
    closed = rig.neutral + rig.deltas[rig.names.index(blink)]
    growth = _areas(closed, triangles) / np.maximum(_areas(rig.neutral, triangles), 1e-9)
    share = np.clip((growth - limits[0]) / (limits[1] - limits[0]), 0, 1)
    core = np.zeros(len(model.mean))
    np.maximum.at(core, triangles.ravel(), (share * share * (3 - 2 * share)).repeat(3))
    core[lid_rings(model, side).upper] = 1
    degree = np.maximum(np.asarray(edges.sum(1)).ravel(), 1)
    zone = core
    for _ in range(_SOFTEN):
        zone = np.maximum(core, (edges @ zone) / degree * around)
    return zone


def _areas(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1))
