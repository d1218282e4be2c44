"""The one-rings of a reference mesh: what deformation gradients at vertices are made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.operators.small_matrices import product
from toongeo.geometry.validate_mesh import MeshLike, validate_mesh

__all__ = ["OneRings", "one_rings"]

_CLAMP = 1e-2  # smallest cotangent weight: with negative ones, rings around obtuse angles are indefinite
_TIE = 1e-3  # weight, against the ring's own, of what the neighbouring rings say about its normal direction
_FLAT = 1e-6  # smallest ratio of a Gram's eigenvalues at which its edges still tell the normal direction
_THIN = 1e-10  # the same for the direction across edges that lie on a line


@dataclass(frozen=True, eq=False)
class OneRings:
    """The one-rings of a reference mesh with their cotangent weights; made by `one_rings`.

    Matrices stand along the last axis: entry ``[a, b, i]`` belongs to vertex ``i``.

    Attributes
    ----------
    V : (n, 3) float64
        Reference vertices.
    F : (m, 3) int64
    laplacian : (n, n) csr_matrix
        Positive semi-definite, with the clamped weights: ``sum_ij c_ij |e'_ij|^2 = 2 tr(P^T L P)``.
    gram : (3, 3, n) float64
        ``C_i = sum_j c_ij e_ij e_ij^T``.
    normal : (3, n) float64
        Unit vectors along which each ring extends least, of either sign.
    flat : (n,) bool
        Rings that lie in a plane with all their neighbours: no edge tells the gradient along the normal.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.geometry import one_rings
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> rings = one_rings(V, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> bool(np.allclose(rings.displacement_gradients(2 * V), np.eye(3)[:, :, None]))  # T - I, twice as large
    True
    """

    V: Floats
    F: NDArray[np.int64]
    laplacian: sp.csr_matrix
    gram: Floats
    normal: Floats
    flat: NDArray[np.bool_]
    _moments: sp.csr_matrix  # (3 n, n)
    _around: sp.csr_matrix  # (n, n) ones: a ring and its neighbours'
    _across: Floats  # (3, n) two-ring Gram^-1 normal
    _inverse: Floats  # (3, 3, n) of the tied Gram
    _tie: Floats  # (n,)

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "V", "F", "gram", "normal", "flat")

    def moments(self, P: Floats) -> Floats:
        """``M_i = sum_j c_ij (p_i - p_j) e_ij^T`` (3, 3, n) of positions or displacements (n, 3)."""
        n = len(self.V)
        return np.ascontiguousarray((self._moments @ P).reshape(3, n, 3).transpose(2, 0, 1))

    def spread(self, T: Floats) -> Floats:
        """Transpose of `moments`: ``sum_j c_ij (T_i + T_j) e_ij`` (n, 3) of gradients (3, 3, n), Eq. 8's right side."""
        return self._moments.T @ T.transpose(1, 2, 0).reshape(-1, 3)

    def displacement_gradients(self, P: Floats) -> Floats:
        """``T_i - I`` (3, 3, n) for deformed vertices (n, 3), as `deformation_gradients` describes."""
        M = self.moments(P - self.V)
        n = M.shape[2]
        wide = (self._around @ M.reshape(9, n).T).T.reshape(3, 3, n)
        along = (wide * self._across).sum(axis=1)
        D = product(M + (self._tie * along)[:, None] * self.normal, self._inverse)
        if self.flat.any():
            self._turn_normals(D)
        return D

    def _turn_normals(self, D: Floats) -> None:
        """Let the gradient of a flat ring take its normal to that of the deformed ring, as long as its area's root."""
        u = self.normal[:, self.flat]
        seed = np.zeros_like(u)
        seed[np.abs(u).argmin(axis=0), np.arange(u.shape[1])] = 1.0
        a = np.cross(seed, u, axis=0)
        a /= np.linalg.norm(a, axis=0)
        b = np.cross(u, a, axis=0)
        flat = D[:, :, self.flat]
        n = np.cross(a + np.einsum("abn,bn->an", flat, a), b + np.einsum("abn,bn->an", flat, b), axis=0)
        root = np.sqrt(np.linalg.norm(n, axis=0))
        turned = np.divide(n, root, out=np.zeros_like(n), where=root > 0)
        change = turned - u - np.einsum("abn,bn->an", flat, u)
        D[:, :, self.flat] = flat + change[:, None] * u


def one_rings(V: MeshLike, F: ArrayLike | None) -> OneRings:
    """Gather the one-rings of a reference mesh, with cotangent weights brought into [0.01, 100].

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices, any unit.
    F : (m, 3) int, or None with a Trimesh
        Triangles.

    Returns
    -------
    OneRings

    Raises
    ------
    ValueError
        On a malformed mesh, a triangle without area, a vertex in no triangle, or one whose edges lie on a line.

    Examples
    --------
    >>> rings = one_rings([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> rings.gram.shape, int(rings.flat.sum())
    ((3, 3, 4), 0)
    """
    V, F = validate_mesh(V, F, nondegenerate=True)
    n = len(V)
    loose = np.flatnonzero(np.bincount(F.ravel(), minlength=n) == 0)
    if len(loose):
        raise ValueError(f"V: expected every vertex in a triangle, got {len(loose)} in none, the first V[{loose[0]}]")
    L = cotangent_laplacian(V, F, clamp=_CLAMP)
    edges = L.tocoo()
    proper = edges.row != edges.col
    i, j, c = edges.row[proper], edges.col[proper], -edges.data[proper]
    e = V[i] - V[j]
    gram: Floats = (
        np.stack([np.bincount(i, c * e[:, a] * e[:, b], n) for a in range(3) for b in range(3)], 1)
        .reshape(n, 3, 3)
        .astype(float)
    )
    around = sp.csr_matrix((np.ones(len(i)), (i, j)), (n, n)) + sp.identity(n, format="csr")
    values, axes = np.linalg.eigh(gram)
    normal = np.ascontiguousarray(axes[:, :, 0])
    wide, wide_axes = np.linalg.eigh((around @ gram.reshape(n, 9)).reshape(n, 3, 3))
    line = np.flatnonzero(values[:, 1] <= _THIN * values[:, 2])
    if len(line):
        raise ValueError(f"V: expected rings that span a plane, got {len(line)} on a line, the first at V[{line[0]}]")
    flat = wide[:, 0] <= _FLAT * wide[:, 2]
    wide[flat] = np.inf
    across = np.einsum("nab,nb,ncb,nc->na", wide_axes, 1 / wide, wide_axes, normal)
    tie = _TIE * values.sum(axis=1)
    inverse: Floats = np.linalg.inv(gram + tie[:, None, None] * normal[:, :, None] * normal[:, None, :])
    return OneRings(
        V=V,
        F=F,
        laplacian=L,
        gram=_along_last(gram),
        normal=np.ascontiguousarray(normal.T),
        flat=flat,
        _moments=_moment_operator(i, j, c[:, None] * e, n),
        _around=around,
        _across=np.ascontiguousarray(across.T),
        _inverse=_along_last(inverse),
        _tie=tie,
    )


def _along_last(matrices: Floats) -> Floats:
    return np.ascontiguousarray(matrices.transpose(1, 2, 0))


def _moment_operator(i: NDArray[np.int32], j: NDArray[np.int32], weighted: Floats, n: int) -> sp.csr_matrix:
    """(3 n, n): row ``b n + i`` gives ``sum_j c_ij e_ij[b] (p_i - p_j)``."""
    rows = np.concatenate([b * n + i for b in range(3)])
    data = weighted.T.ravel()
    operator = sp.csr_matrix((np.r_[data, -data], (np.r_[rows, rows], np.r_[np.tile(i, 3), np.tile(j, 3)])), (3 * n, n))
    return operator
