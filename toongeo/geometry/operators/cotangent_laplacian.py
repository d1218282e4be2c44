"""The cotangent Laplacian of a triangle mesh."""

from __future__ import annotations

import igl
import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from toongeo.arrays import Floats, Integers, Mask
from toongeo.geometry.validate_mesh import MeshLike, degenerate_triangles, validate_mesh

__all__ = ["cotangent_laplacian"]

_THIN = 1e-6  # sine of the smallest angle: libigl loses the area below 1e-8


def cotangent_laplacian(V: MeshLike, F: ArrayLike | None, *, clamp: float | None = None) -> sp.csr_matrix:
    """Positive semi-definite cotangent Laplacian: ``x^T C x = integral |grad x|^2``.

    Off-diagonal ``C_ij = -w_ij`` with ``w_ij = (cot a_ij + cot b_ij) / 2`` of the angles that face the
    edge; the diagonal makes every row sum to zero. It is built by libigl's ``cotmatrix``, which has the other sign.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices. The result does not depend on the unit.
    F : (m, 3) int, or None with a Trimesh
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
    if clamp is None:
        thin = igl.doublearea(V, F) <= _THIN * igl.squared_edge_lengths(V, F).max(axis=1)
        C = _with_thin(V, F, thin) if thin.any() else _rows(igl.cotmatrix(V, F))
        C.data *= -1
        return C
    C = _rows(igl.cotmatrix(V, F))
    if not np.isfinite(C.data).all():  # one triangle without area is enough
        flat = degenerate_triangles(V, F)
        C = _with_flat(_rows(igl.cotmatrix(V, F[~flat])), V, F[flat])
    return _clamped(C, clamp)


def _rows(C: sp.csc_matrix) -> sp.csr_matrix:
    """A symmetric matrix by rows, without a copy."""
    return sp.csr_matrix((C.data, C.indices, C.indptr), shape=C.shape)


def _with_thin(V: Floats, F: Integers, thin: Mask) -> sp.csr_matrix:
    """libigl's matrix of a mesh with thin triangles, of which it loses the area: it takes it from lengths of edges."""
    rest = F[~thin]
    C = _rows(igl.cotmatrix(V, rest)) if len(rest) else sp.csr_matrix((len(V), len(V)))
    for k in range(3):
        tip, i, j = (F[thin][:, (k + step) % 3] for step in range(3))
        a, b = V[i] - V[tip], V[j] - V[tip]
        half = 0.5 * (a * b).sum(axis=1) / np.linalg.norm(np.cross(a, b), axis=1)
        weights = np.concatenate([half, half, -half, -half])
        places = np.concatenate([i, j, i, j]), np.concatenate([j, i, i, j])
        C = sp.csr_matrix(C + sp.csr_matrix((weights, places), shape=(len(V), len(V))))
    return C


def _clamped(C: sp.csr_matrix, clamp: float) -> sp.csr_matrix:
    """libigl's matrix with weights within bounds, the diagonal that belongs to them, and our sign."""
    row = np.repeat(np.arange(C.shape[0]), np.diff(C.indptr))
    diagonal = C.indices == row
    weight = np.clip(C.data, clamp, 1 / clamp)
    weight[diagonal] = 0.0
    total = np.bincount(row, weight, minlength=C.shape[0])
    data = np.negative(weight, out=weight)
    data[diagonal] = total[row[diagonal]]
    return sp.csr_matrix((data, C.indices, C.indptr), shape=C.shape)


def _with_flat(C: sp.csr_matrix, V: Floats, F: Integers) -> sp.csr_matrix:
    """Add the edges of triangles without area; what stands on the diagonal is not looked at."""
    X, corners = np.ascontiguousarray(V.T), np.ascontiguousarray(F.T)
    x = [X[:, corner] for corner in corners]
    C = C.tocoo()
    rows, columns, weights = [C.row], [C.col], [C.data]
    for k in range(3):
        tip, i, j = k, (k + 1) % 3, (k + 2) % 3
        # A flat angle has cotangent +-infinity, bounded here because infinities of two triangles must not cancel to
        # NaN; coincident corners have no angle and give zero.
        half = 0.5e12 * np.sign(((x[i] - x[tip]) * (x[j] - x[tip])).sum(axis=0))
        edge = corners[i] != corners[j]
        rows += [corners[i][edge], corners[j][edge], corners[i][edge]]
        columns += [corners[j][edge], corners[i][edge], corners[i][edge]]
        weights += [half[edge], half[edge], np.zeros(edge.sum())]
    # Zeros stay, unlike in a sum of matrices: an edge whose weights cancel is one all the same.
    entries = np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))
    return sp.csr_matrix(entries, shape=C.shape)
