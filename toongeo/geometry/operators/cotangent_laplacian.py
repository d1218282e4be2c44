"""The cotangent Laplacian of a triangle mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.operators.cross import cross
from toongeo.geometry.validate_mesh import validate_mesh

__all__ = ["cotangent_laplacian"]


def cotangent_laplacian(V: ArrayLike, F: ArrayLike, *, clamp: float | None = None) -> sp.csr_matrix:
    """Positive semi-definite cotangent Laplacian: ``x^T C x = integral |grad x|^2``.

    Off-diagonal ``C_ij = -w_ij`` with ``w_ij = (cot a_ij + cot b_ij) / 2`` of the angles that face the
    edge; the diagonal makes every row sum to zero. (libigl's ``cotmatrix`` has the other sign.)

    Parameters
    ----------
    V : (n, 3) float
        Vertices. The result does not depend on the unit.
    F : (m, 3) int
        Triangles.
    clamp : float in (0, 1], optional
        Bring every edge weight into ``[clamp, 1 / clamp]``. Then all off-diagonals are negative (rings
        around obtuse angles otherwise are not), and degenerate triangles are allowed.

    Returns
    -------
    (n, n) csr_matrix of float64

    Raises
    ------
    ValueError
        On a malformed mesh, on a degenerate triangle where `clamp` is None, or on a `clamp` outside (0, 1].

    References
    ----------
    U. Pinkall, K. Polthier, "Computing discrete minimal surfaces and their conjugates", 1993.

    Examples
    --------
    >>> C = cotangent_laplacian([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> C.toarray().round(9) + 0.0
    array([[ 1. , -0.5, -0.5],
           [-0.5,  0.5,  0. ],
           [-0.5,  0. ,  0.5]])
    """
    if clamp is not None and not 0 < clamp <= 1:
        raise ValueError(f"clamp: expected a number in (0, 1] or None, got {clamp}")
    V, F = validate_mesh(V, F, nondegenerate=clamp is None)
    n = len(V)
    W = _edge_weights(V, F, n)
    if clamp is not None:
        W.data = np.clip(W.data, clamp, 1 / clamp)
    return sp.csr_matrix(sp.diags_array(W.sum(axis=1).A1) - W)


def _edge_weights(V: NDArray[np.float64], F: NDArray[np.int64], n: int) -> sp.csr_matrix:
    """Symmetric (n, n) matrix of the half sums of cotangents, every edge stored even where they cancel."""
    X, corners = np.ascontiguousarray(V.T), np.ascontiguousarray(F.T)
    x = [X[:, corner] for corner in corners]
    rows, columns, weights = [], [], []
    for k in range(3):
        tip, i, j = k, (k + 1) % 3, (k + 2) % 3
        u, v = x[i] - x[tip], x[j] - x[tip]
        twice_area = np.sqrt((cross(u, v) ** 2).sum(axis=0))
        dot = (u * v).sum(axis=0)
        # A flat angle has cotangent +-infinity, bounded here because infinities of two triangles must not
        # cancel to NaN; coincident corners have no angle and give zero.
        angle = twice_area > 1e-12 * np.abs(dot)
        cotangent = np.divide(dot, twice_area, out=np.sign(dot) * 1e12, where=angle)
        edge = corners[i] != corners[j]
        rows += [corners[i][edge], corners[j][edge]]
        columns += [corners[j][edge], corners[i][edge]]
        weights += [0.5 * cotangent[edge]] * 2
    entries = np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))
    return sp.csr_matrix(entries, shape=(n, n))
