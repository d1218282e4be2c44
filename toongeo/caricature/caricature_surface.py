"""Any surface, exaggerated where it is curved."""

from __future__ import annotations

import igl
import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry import MeshLike, validate_mesh, vertex_components
from toongeo.geometry.operators.factor import factor_spd, solve

__all__ = ["caricature_surface"]

_RANGE = (0.02, 0.98)  # quantiles of the curvature that count; a single vertex can have any angle defect


def caricature_surface(V: MeshLike, F: ArrayLike | None, gamma: float) -> NDArray[np.float64]:
    """Caricature of a surface by its own curvature (Sela et al. 2015).

    The gradients of the three coordinates are multiplied by ``|K|^gamma``, K the Gaussian curvature, and integrated
    again by a Poisson equation: noses and chins grow, cheeks and the forehead shrink. The factors are
    normalized to a mean of one over each connected component, so sizes stay about the same, and the unit does not
    matter. A piece that is flat but for some edges stays as it is.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices, any unit.
    F : (m, 3) int, or None with a Trimesh
        Triangles.
    gamma : float
        0 changes nothing, 0.1 to 0.3 exaggerate, negative values flatten.

    Returns
    -------
    (n, 3) float64
        Each connected component keeps the mean of its vertices.

    Raises
    ------
    ValueError
        On a malformed mesh, a triangle without area, or a gamma that is not finite.

    References
    ----------
    M. Sela, Y. Aflalo, R. Kimmel, "Computational caricaturization of surfaces", CVIU 141, 2015.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> np.abs(caricature_surface(V, F, 0.0) - V).max() < 1e-12
    np.True_
    """
    V, F = validate_mesh(V, F, nondegenerate=True)
    if not np.isfinite(gamma):
        raise ValueError(f"gamma: expected a finite number, got {gamma}")
    area = igl.doublearea(V, F) / 2
    component = vertex_components(F, len(V))
    factors = np.ones(len(F))
    for part in np.unique(component):  # each by itself: teeth are curved more than any skin
        inside = component[F[:, 0]] == part
        factors[inside] = _factors(V, F[inside], area[inside], gamma)
    G = igl.grad(V, F)  # (3 m, n): x, y and z of the gradients
    weighted = sp.csr_matrix(G.T @ sp.diags_array(np.tile(area, 3)))
    free = np.setdiff1d(np.arange(len(V)), np.unique(component, return_index=True)[1])
    K = sp.csr_matrix(weighted @ G)[free][:, free]
    moved = np.zeros_like(V)  # the displacement is solved for: factors of one give the surface to the last bit
    moved[free] = solve(factor_spd(K), (weighted @ (np.tile(factors - 1, 3)[:, None] * (G @ V)))[free])
    count = np.bincount(component)[:, None]
    shift = np.stack([np.bincount(component, column) for column in moved.T], axis=1) / count
    return V + moved - shift[component]


def _factors(
    V: NDArray[np.float64], F: NDArray[np.int64], area: NDArray[np.float64], gamma: float
) -> NDArray[np.float64]:
    """``|K|^gamma`` of triangles (m,), over its mean; one where a piece has only a border."""
    share = np.bincount(F.ravel(), np.repeat(area / 3, 3), len(V))
    inside = share > 0
    inside[igl.boundary_facets(F)[0]] = False  # the angle defect of a border is no curvature
    if not inside.any():
        return np.ones(len(F))
    K = np.abs(igl.gaussian_curvature(V, F)) / np.where(share > 0, share, 1.0)
    low, high = np.quantile(K[inside], _RANGE)
    if low <= 0:
        return np.ones(len(F))  # mostly flat
    K = np.where(inside, np.clip(K, low, high), np.median(K[inside]))
    factors = K[F].mean(axis=1) ** gamma
    factors /= (factors * area).sum() / area.sum()
    return factors
