"""Heights over triangles, smoothed as a surface in space."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.pipeline.hair.shell.edges import edges_of

__all__ = ["faired"]

Floats = NDArray[np.floating]
_ROUNDS, _SHRINK, _SWELL = 25, 0.5, -0.51  # of Taubin 1995: a round keeps what is broad as large as it was
_FLOOR_MM2 = 1.0  # added to squared lengths of edges, so that none counts for all


def faired(
    P: Floats, T: NDArray[np.int64], z: Floats, free: NDArray[np.bool_], floor: Floats, ceiling: Floats
) -> Floats:
    """Heights (n,) whose free vertices were smoothed towards their neighbours, the nearer in space the more.

    Points keep their place in the plane, so that the surface stays one over it; P (n, 2), T (m, 3). The result is not
    below the floor nor above the ceiling (n,).
    """
    edges, _, _ = edges_of(T)
    a, b = edges.T
    X = np.column_stack([P, z])
    weight = 1 / (((X[a] - X[b]) ** 2).sum(1) + _FLOOR_MM2)
    n = len(P)
    W = sp.csr_array((np.r_[weight, weight], (np.r_[a, b], np.r_[b, a])), (n, n))
    rows = np.flatnonzero(free)
    W = sp.diags_array(1 / np.asarray(W.sum(1)).ravel()[rows]) @ W[rows]
    smooth = z.copy()
    for _ in range(_ROUNDS):
        for step in (_SHRINK, _SWELL):
            smooth[rows] += step * (W @ smooth - smooth[rows])
        smooth[rows] = np.clip(smooth[rows], floor[rows], np.maximum(ceiling[rows], floor[rows]))
    return smooth
