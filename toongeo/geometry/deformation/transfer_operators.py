"""The linear system of deformation transfer, with the fourth vertices eliminated."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.geometry.operators.cross import cross

__all__ = ["fourth_edges", "transfer_operators"]

# Sine of a triangle's smallest angle, about, below which it counts less in the energy, by the square: its gradients
# grow as one over the sine, a sliver outweighs all others and throws its corners as far. The slimmest triangle of the
# template has 0.046.
_SLIVER = 1e-3


def fourth_edges(V: NDArray[np.float64], corners: NDArray[np.int64]) -> NDArray[np.float64]:
    """``n / sqrt|n|`` (m, 3), ``n`` the cross product of two edges (Eq. 14); 0 for a collapsed triangle."""
    X = np.ascontiguousarray(V.T)
    a, b, c = (X[:, corner] for corner in corners)
    normal = cross(b - a, c - a)
    root = np.sqrt(np.sqrt((normal**2).sum(axis=0)))
    return np.divide(normal, root, out=np.zeros_like(normal), where=root > 0).T


def _dual_edges(
    V: NDArray[np.float64], corners: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Rows of the inverse of ``[e1, e2, n / sqrt|n|]``, coordinates first: three arrays (3, m)."""
    X = np.ascontiguousarray(V.T)
    a, b, c = (X[:, corner] for corner in corners)
    e1, e2 = b - a, c - a
    normal = cross(e1, e2)
    squared = (normal**2).sum(axis=0)
    return cross(e2, normal) / squared, cross(normal, e1) / squared, normal / squared**0.75


def _fullness(V: NDArray[np.float64], corners: NDArray[np.int64]) -> NDArray[np.float64]:
    """How much each triangle counts (m,): 1, and less for slivers."""
    X = np.ascontiguousarray(V.T)
    a, b, c = (X[:, corner] for corner in corners)
    longest = np.maximum(np.maximum(((b - a) ** 2).sum(axis=0), ((c - a) ** 2).sum(axis=0)), ((c - b) ** 2).sum(axis=0))
    sine = np.sqrt((cross(b - a, c - a) ** 2).sum(axis=0)) / longest
    return np.minimum(1.0, (sine / _SLIVER) ** 2)


def transfer_operators(
    source: NDArray[np.float64], target: NDArray[np.float64], corners: NDArray[np.int64], *, by_area: bool = False
) -> tuple[sp.csr_matrix, sp.csr_matrix, sp.csr_matrix]:
    """``K`` (n, n), ``B`` (n, n), ``N`` (n, m) with ``K x = B v + N (n / sqrt|n|)`` for a deformed source v.

    The gradients of the target's hat functions are its first two dual edges ``g1, g2`` and
    ``g0 = -g1 - g2``: they lie in the triangle, so the fourth vertex, which adds a normal part to ``Q'``,
    drops out. Then ``K`` sums ``g_a . g_b``, and the right-hand side sums ``Q g_a`` with
    ``Q = [e1, e2, n / sqrt|n|] [h1; h2; h3]`` where ``h`` are the dual edges of the source at rest.
    """
    n, m = len(source), corners.shape[1]
    g1, g2, _ = _dual_edges(target, corners)
    gradients = (-g1 - g2, g1, g2)
    weight = 1 / np.sqrt((cross(g1, g2) ** 2).sum(axis=0)) if by_area else 1.0  # of the triangle: twice its area
    weight = weight * np.minimum(_fullness(source, corners), _fullness(target, corners))
    weighted = tuple(weight * g for g in gradients)
    h1, h2, h3 = _dual_edges(source, corners)
    hats = (-h1 - h2, h1, h2)

    rows = np.concatenate([corners[a] for a in range(3) for _ in range(3)])
    columns = np.concatenate([corners[b] for _ in range(3) for b in range(3)])
    stiffness = np.concatenate([(ga * gb).sum(axis=0) for ga in weighted for gb in gradients])
    mixed = np.concatenate([(ga * hb).sum(axis=0) for ga in weighted for hb in hats])
    tilt = np.concatenate([(ga * h3).sum(axis=0) for ga in weighted])
    K = sp.csr_matrix((stiffness, (rows, columns)), shape=(n, n))
    B = sp.csr_matrix((mixed, (rows, columns)), shape=(n, n))
    N = sp.csr_matrix((tilt, (corners.ravel(), np.tile(np.arange(m), 3))), shape=(n, m))
    return K, B, N
