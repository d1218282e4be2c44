"""Expressions that are as like each other as those of a normal face."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats
from toongeo.caricature.blendshapes.optimize_blendshapes import expression_similarities
from toongeo.geometry.one_thread import one_thread

__all__ = ["restore_similarities"]

_FLAT = 1e-12  # of the largest eigenvalue: directions that no expression has


def restore_similarities(D: ArrayLike, D_normal: ArrayLike) -> Floats:
    """The shapes nearest to D whose cosines (Eq. 8) are those of the normal face.

    E_str of `optimize_blendshapes` draws like expressions together, and so makes them more alike than they are in the
    normal face. This gives every expression back its share: of all sets of shapes with the sizes of D and the cosines
    of ``D_normal``, it is the one at the least distance, each shape measured by its size. It is a linear combination
    of D that mixes only what overlaps.

    Parameters
    ----------
    D, D_normal : (k, n, 3) float
        Expressions that move nothing in either stay as they are.

    Returns
    -------
    (k, n, 3) float64

    Raises
    ------
    ValueError
        If the two differ in shape, or a number is not finite.

    Examples
    --------
    >>> D = np.array([[[1.0, 0, 0]], [[0.6, 0.8, 0]]])
    >>> apart = np.array([[[1.0, 0, 0]], [[0.0, 1, 0]]])
    >>> expression_similarities(restore_similarities(D, apart)).round(6) + 0.0
    array([[1., 0.],
           [0., 1.]])
    """
    shapes, normal = np.asarray(D, np.float64), np.asarray(D_normal, np.float64)
    if shapes.ndim != 3 or shapes.shape != normal.shape:
        raise ValueError(f"D_normal: expected the shape of D {shapes.shape}, got {normal.shape}")
    for name, array in (("D", shapes), ("D_normal", normal)):
        if not np.isfinite(array).all():
            raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")
    own, wanted = expression_similarities(shapes), expression_similarities(normal)
    acting = (own.diagonal() > 0) & (wanted.diagonal() > 0)
    flat = shapes[acting].reshape(int(acting.sum()), -1)
    sizes = np.linalg.norm(flat, axis=1)
    with one_thread():
        # Orthogonal Procrustes: T (unit shapes) with T G T^T = W nearest to the identity in the metric of G.
        root = _power(wanted[np.ix_(acting, acting)], 0.5)
        mix = root @ _power(root @ own[np.ix_(acting, acting)] @ root, -0.5) @ root
        mixed = (sizes[:, None] * mix / sizes) @ flat
    restored = shapes.copy()
    restored[acting] = mixed.reshape(-1, *shapes.shape[1:])
    return restored


def _power(A: Floats, exponent: float) -> Floats:
    """Power of a symmetric positive semi-definite matrix."""
    values, vectors = np.linalg.eigh(A)
    return np.asarray((vectors * np.maximum(values, _FLAT * values.max()) ** exponent) @ vectors.T)
