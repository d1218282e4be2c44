"""Blendshapes of a caricature made as orderly as those of a normal face (Chen et al. 2020, section 3.2.3)."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats
from toongeo.caricature.blendshapes.shifted_systems import shifted_solutions
from toongeo.geometry import cotangent_laplacian, validate_mesh
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.factor import factor_spd, solve

__all__ = [
    "BlendshapeWeights",
    "displacement_masks",
    "expression_similarities",
    "optimize_blendshapes",
    "signed_graph",
    "squared_laplacian",
]

_STILL = 1e-6  # of the largest motion: what moves less in the normal face does not move
_CLAMP = 0.05  # cotangent weights of thin triangles


@dataclass(frozen=True)
class BlendshapeWeights:
    """Weights of `optimize_blendshapes`.

    Attributes
    ----------
    deformation, structure, smoothness : float
        Lambda of E_def, E_str and E_smo (Eq. 11).
    reach : float
        Length in units of the V given, beyond which E_str outweighs the Laplacian terms at equal weights: a
        Laplacian is per length^2, and so has to be multiplied by a length^2 to be compared with a displacement.
    saturation : float in (0, 1]
        Share of an expression's largest motion from which the mask is 1. With 1 it is that of Eq. 6, which also
        halves what the normal face moves half as far as its farthest point: an opening jaw becomes a spike. With a
        tenth only what is all but still there is held still.
    softness : float
        Length in units of the V given over which the masks fade; 0 leaves them as they are.

    Raises
    ------
    ValueError
        If one is negative or not finite, deformation, reach or saturation is zero, or the latter above 1.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.BlendshapeWeights(saturation=0.1, softness=4.0).saturation
    0.1
    >>> tg.BlendshapeWeights(reach=0.0)
    Traceback (most recent call last):
    ...
    ValueError: reach: expected a finite number > 0, got 0.0
    """

    deformation: float = 1.0
    structure: float = 0.1
    smoothness: float = 0.05
    reach: float = 60.0
    saturation: float = 1.0
    softness: float = 0.0

    def __post_init__(self) -> None:
        for option in fields(self):
            value = getattr(self, option.name)
            least = "> 0" if option.name in ("deformation", "reach", "saturation") else ">= 0"
            if not np.isfinite(value) or value < 0 or (value == 0 and least == "> 0"):
                raise ValueError(f"{option.name}: expected a finite number {least}, got {value}")
        if self.saturation > 1:
            raise ValueError(f"saturation: expected a number in (0, 1], got {self.saturation}")


def optimize_blendshapes(
    D: ArrayLike, D_normal: ArrayLike, V: ArrayLike, F: ArrayLike, weights: BlendshapeWeights | None = None
) -> Floats:
    r"""Residual blendshapes D* that keep a caricature's identity and the order among its expressions (Eq. 4-11).

    D* minimizes, over k expressions on a mesh,

    - ``E_def = sum_i |Delta (D*_i - M_i D_i)|^2`` (Eq. 7), where the mask M_i (Eq. 6) is the normal face's motion
      divided by its largest: what does not move there stays here;
    - ``E_str = 1 / (k - 1) sum_ij |c_ij| |D*_i - sgn(c_ij) D*_j|^2`` (Eq. 9), with the cosines c_ij of the normal
      face's expressions (Eq. 8);
    - ``E_smo = sum_i |Delta D*_i|^2`` (Eq. 10).

    Delta is the cotangent Laplacian of V times ``reach^2 / mean vertex area``, so that the three energies have one
    unit and the mesh's resolution does not shift their balance.

    Eq. 9 as printed, ``sum c_ij |D*_i - D*_j|^2``, is not bounded below when cosines are negative, as nearly half of
    them are: opposite expressions could be driven apart for ever. In the signed form they are drawn towards each
    other's opposite. It equals the printed one where ``c_ij >= 0``; as a sum of squares it is never negative, and
    the whole has one minimum. It is divided by k - 1, the number of partners an expression has: as a sum over pairs
    it would outgrow the others, which are sums over expressions, and flatten everything.

    An expression that moves no vertex in the normal face (``tongueOut`` on the skin, or the one that the source
    already shows) has no mask and no cosine: D* is zero for it, and it takes no part in E_str. A vertex that no
    expression moves there is held.

    Parameters
    ----------
    D : (k, n, 3) float
        Shapes of the caricature minus its source shape (Eq. 4), k >= 2.
    D_normal : (k, n, 3) float
        The same of the normal face (Eq. 5).
    V : (n, 3) float
        The source shape.
    F : (m, 3) int
    weights : BlendshapeWeights, optional

    Returns
    -------
    (k, n, 3) float64

    Raises
    ------
    ValueError
        If shapes do not fit each other, a number is NaN or infinite, the mesh is malformed, or nothing moves.

    References
    ----------
    Chen, Zheng, Cai, Zhang 2020, "Modeling caricature expressions by 3D blendshape and dynamic texture".

    Examples
    --------
    >>> import numpy as np
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> D = np.zeros((2, 4, 3))
    >>> D[0, 1, 0], D[1, 2, 1] = 0.5, 0.5
    >>> optimize_blendshapes(D, D, V, F, BlendshapeWeights(structure=0, smoothness=0)).round(6)[0, 1]
    array([0.5, 0. , 0. ])
    """
    weights = BlendshapeWeights() if weights is None else weights
    D, D_normal, V, F = _checked(D, D_normal, V, F)
    masks = displacement_masks(D_normal, weights.saturation)
    moving, acting = masks.max(axis=0) > 0, masks.max(axis=1) > 0
    if not moving.any():
        raise ValueError("D_normal: expected an expression that moves a vertex, got none")
    masks = _faded(masks, V, F, weights.softness) if weights.softness else masks
    K = squared_laplacian(V, F, weights.reach)[moving]
    wanted = masks[acting][:, :, None] * D[acting]
    pull = weights.deformation * (K @ wanted.transpose(1, 0, 2).reshape(len(V), -1))
    similarity = expression_similarities(D_normal[acting])
    with one_thread():
        shifts, turn = np.linalg.eigh(weights.structure * signed_graph(similarity))
        pull = np.einsum("nkc,kl->nlc", pull.reshape(len(pull), -1, 3), turn)
        stiffness = (weights.deformation + weights.smoothness) * K[:, moving]
        solution = shifted_solutions(stiffness, np.maximum(shifts, 0.0), pull)
        found = np.einsum("nlc,kl->knc", solution, turn)
    best = np.zeros_like(D)
    best[np.ix_(acting, moving)] = found
    return best


def displacement_masks(D_normal: Floats, saturation: float = 1.0) -> Floats:
    """M (k, n) in [0, 1] of Eq. 6: how far each vertex moves beside the one that moves farthest; zero if none does."""
    sizes = np.linalg.norm(D_normal, axis=2)
    peaks = sizes.max(axis=1, keepdims=True)
    moves = peaks > _STILL * max(float(peaks.max()), 1e-300)
    masks = np.divide(sizes, peaks, out=np.zeros_like(sizes), where=moves)
    return np.where(masks > _STILL, np.minimum(masks / saturation, 1.0), 0.0)


def expression_similarities(D: Floats) -> Floats:
    """Cosines (k, k) of Eq. 8 between expressions (k, n, 3); zero for one that moves nothing."""
    flat = D.reshape(len(D), -1)
    with one_thread():
        gram = flat @ flat.T
    lengths = np.sqrt(gram.diagonal())
    unit = np.divide(1.0, lengths, out=np.zeros_like(lengths), where=lengths > _STILL * max(lengths.max(), 1e-300))
    return np.asarray(gram * unit[:, None] * unit)


def signed_graph(similarity: Floats) -> Floats:
    """Matrix G (k, k) of ``E_str = tr(D^T G D)``: positive semi-definite, as a sum of squares."""
    c = similarity - np.diag(similarity.diagonal())
    return np.asarray(2.0 / max(len(c) - 1, 1) * (np.diag(np.abs(c).sum(axis=1)) - c))


def squared_laplacian(V: Floats, F: NDArray[np.int64], reach: float) -> sp.csr_matrix:
    """``Delta^T Delta`` (n, n), with Delta scaled by ``reach^2 / mean vertex area``."""
    L = cotangent_laplacian(V, F, clamp=_CLAMP) * (reach**2 / _mean_vertex_area(V, F))
    return sp.csr_matrix(L @ L)


def _faded(masks: Floats, V: Floats, F: NDArray[np.int64], length: float) -> Floats:
    """Masks (k, n) after a step of implicit diffusion over a length, on a mesh of even density."""
    L = cotangent_laplacian(V, F, clamp=_CLAMP) * (length**2 / _mean_vertex_area(V, F))
    return solve(factor_spd(sp.eye_array(len(V)) + L), np.ascontiguousarray(masks.T)).T


def _mean_vertex_area(V: Floats, F: NDArray[np.int64]) -> float:
    corners = V[F]
    doubled = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return float(doubled.sum() / 2 / len(V))


def _checked(
    D: ArrayLike, D_normal: ArrayLike, V: ArrayLike, F: ArrayLike
) -> tuple[Floats, Floats, Floats, NDArray[np.int64]]:
    V, F = validate_mesh(V, F)
    arrays = []
    for name, value in (("D", D), ("D_normal", D_normal)):
        array = np.asarray(value, np.float64)
        if array.ndim != 3 or array.shape[1:] != V.shape or len(array) < 2:
            raise ValueError(f"{name}: expected shape (k, {len(V)}, 3) with k >= 2, got {array.shape}")
        if not np.isfinite(array).all():
            raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")
        arrays.append(array)
    if arrays[0].shape != arrays[1].shape:
        raise ValueError(f"D_normal: expected the shape of D {arrays[0].shape}, got {arrays[1].shape}")
    return arrays[0], arrays[1], V, F
