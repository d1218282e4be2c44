"""Weights of a rig for any expression of its face model (Chen et al. 2020, Eq. 19-20)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import lsq_linear

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.model.morphable_model import MorphableModel

__all__ = ["weights_of_expression"]

_TINY = 1e-10  # of the mean diagonal: what moves nothing gets weight 0


def weights_of_expression(
    expression: ArrayLike, model: MorphableModel, *, bounds: tuple[float, float] = (0.0, 1.0)
) -> Floats:
    """Weights of the named expressions that come nearest to an expression of the normal face (Eq. 19).

    ``|S(e_r) - S(e_0) - sum_i w_i (S(e_i) - S(e_0))|^2`` is minimized within bounds, over all vertices. In this model
    shapes are linear, so identity cancels and only the Gram matrix of the expressions is needed. With the weights,
    `Rig.vertices` gives the caricature's face (Eq. 20).

    Parameters
    ----------
    expression : (e,) array_like
        All coefficients of the model, as ``FaceFit.expression`` has them.
    model : MorphableModel
    bounds : (lowest, highest)
        Of every weight.

    Returns
    -------
    (n_named,) float64

    Raises
    ------
    ValueError
        If the expression has another length than the model's, or is not finite; if the bounds are not in order.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> expression = np.zeros(len(model.expression))
    >>> expression[model.expression_index("jawOpen")] = 0.6
    >>> round(float(weights_of_expression(expression, model)[model.expression_index("jawOpen")]), 6)
    0.6
    """
    wanted = np.asarray(expression, np.float64)
    if wanted.shape != (len(model.expression),):
        raise ValueError(f"expression: expected shape ({len(model.expression)},), got {wanted.shape}")
    if not np.isfinite(wanted).all():
        raise ValueError("expression: expected finite numbers, got NaN or infinity")
    lowest, highest = bounds
    if not lowest < highest:
        raise ValueError(f"bounds: expected lowest < highest, got {bounds}")
    k = model.n_named
    with one_thread():
        flat = model.expression.reshape(len(model.expression), -1).astype(np.float64)
        gram = flat[:k] @ flat.T
        H = gram[:, :k] + _TINY * gram[:, :k].diagonal().mean() * np.eye(k)
        upper = np.linalg.cholesky(H).T
        target = np.linalg.solve(upper.T, gram @ wanted)
        found = lsq_linear(upper, target, (lowest, highest), method="bvls", max_iter=20 * k).x
    return np.asarray(np.clip(found, lowest, highest))
