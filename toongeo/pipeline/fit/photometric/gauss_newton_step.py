"""A step towards the minimum of a sum of squares within bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit.losses.nlopt_minimize import nlopt_minimize
from toongeo.pipeline.fit.photometric.light_and_albedo import ReducedLoss

__all__ = ["GaussNewtonStep", "gauss_newton_step"]

_HALVINGS = 4  # of a step that does not lower the loss


@dataclass(frozen=True, eq=False)
class GaussNewtonStep:
    """Where a step ends (n,), the loss there, and how the optimizer fared."""

    z: Floats
    value: float
    status: str
    evaluations: int


def gauss_newton_step(
    loss: ReducedLoss,
    z: Floats,
    *,
    bounds: tuple[Floats, Floats],
    algorithm: str,
    tolerance: float,
    max_evaluations: int,
) -> GaussNewtonStep:
    """To the minimum of the quadratic model at ``z`` within bounds, or a part of the way.

    The step is halved until the loss itself falls; if it does not, the answer is ``z``.

    Parameters
    ----------
    loss : ReducedLoss
    z : (n,) float
        Within the bounds.
    bounds, algorithm, tolerance, max_evaluations
        Of `nlopt_minimize`, which minimises the model.
    """
    model = loss.model(z)
    minimum = nlopt_minimize(
        model,
        z,
        bounds=bounds,
        scale=1 / np.sqrt(np.diag(model.matrix)),
        algorithm=algorithm,
        tolerance=tolerance,
        max_evaluations=max_evaluations,
    )
    for halving in range(_HALVINGS):
        found = z + (minimum.x - z) / 2**halving
        value = loss(found)
        if value < model.value:
            return GaussNewtonStep(found, value, minimum.status, minimum.evaluations)
    return GaussNewtonStep(z, model.value, minimum.status, minimum.evaluations)
