"""A pass of a fit: the minimum of its loss by the algorithm that was asked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit.fit_option_groups import SolverOptions
from toongeo.pipeline.fit.losses.decoupled_pose import decoupled_pose
from toongeo.pipeline.fit.losses.gauss_newton import GAUSS_NEWTON, gauss_newton
from toongeo.pipeline.fit.losses.joint_loss import JointLoss
from toongeo.pipeline.fit.losses.nlopt_minimize import Minimum, nlopt_minimize
from toongeo.pipeline.fit.losses.total_loss import TotalLoss

__all__ = ["minimized"]


def minimized(
    loss: TotalLoss | JointLoss, start: Floats, bounds: tuple[Floats, Floats], algorithm: str, solver: SolverOptions
) -> Minimum:
    """The minimum of a loss within bounds, from a start (n,).

    nlopt's optimizers know the unknowns one by one, and get the loss with its pose decoupled, or with unknowns scaled
    where there are several pictures.
    """
    if algorithm == GAUSS_NEWTON:
        return gauss_newton(
            loss,
            start,
            bounds=bounds,
            tolerance=solver.tolerance,
            max_evaluations=solver.max_evaluations,
            max_seconds=solver.max_seconds,
        )
    decoupled = decoupled_pose(loss, start) if isinstance(loss, TotalLoss) else None
    minimum = nlopt_minimize(
        loss if decoupled is None else decoupled,
        start,
        bounds=bounds,
        scale=1 / np.sqrt(loss.curvature(start) if decoupled is None else decoupled.curvature),
        algorithm=algorithm,
        tolerance=solver.tolerance,
        max_evaluations=solver.max_evaluations,
        max_seconds=solver.max_seconds,
    )
    return minimum if decoupled is None else replace(minimum, x=decoupled.x(minimum.x))
