"""One person in several pictures."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.model.default_model import default_model
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_options import FitOptions, changed_options
from toongeo.pipeline.fit.losses.gauss_newton import GAUSS_NEWTON
from toongeo.pipeline.fit.problem.fit_task import check_call, fit_task
from toongeo.pipeline.fit.problem.joint_fit import joint_fit
from toongeo.protocols import Regressor

__all__ = ["fit_3dmm_together"]


def fit_3dmm_together(
    imgs: Sequence[NDArray[np.uint8] | None],
    landmarks: Sequence[ArrayLike],
    *,
    model: MorphableModel | None = None,
    algorithm: str = GAUSS_NEWTON,
    options: FitOptions | None = None,
    regressor: Regressor | None = None,
    **changes: Any,
) -> tuple[FaceFit, ...]:
    """One identity for several pictures of one person, and a pose and an expression in each.

    The loss is the sum of those of `fit_3dmm`, in which the prior of the identity counts once.

    Parameters
    ----------
    imgs : sequence of (H, W, 3) uint8 arrays or None
        Only their sizes are looked at.
    landmarks : sequence of as many (68, 2) array_like, px
        As of `fit_3dmm`.
    model, algorithm, options, regressor, **changes
        As of `fit_3dmm`, for all of them.

    Returns
    -------
    tuple of FaceFit
        One for each picture; their identities are equal. Status, passes and evaluations are those of all.

    Raises
    ------
    ValueError
        As `fit_3dmm`; if there are more or fewer sets of landmarks than pictures, or none.

    Examples
    --------
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> model = default_model()
    >>> views = [ScaledOrthographicCamera.look(yaw=yaw) for yaw in (-20.0, 20.0)]
    >>> points = [view.project(model.mean[model.landmarks]) for view in views]
    >>> first, second = fit_3dmm_together([None, None], points)
    >>> bool((first.identity == second.identity).all()), first.camera.yaw < 0 < second.camera.yaw
    (True, True)
    """
    started = time.perf_counter()
    options = changed_options(options, changes)
    check_call(algorithm, options, regressor)
    model = default_model() if model is None else model
    if len(imgs) == 0 or len(landmarks) != len(imgs):
        raise ValueError(f"landmarks: expected one set for each of {len(imgs)} pictures, got {len(landmarks)}")
    tasks = [fit_task(img, points, model, options, regressor) for img, points in zip(imgs, landmarks, strict=True)]
    with one_thread():
        solutions = joint_fit([task.problem for task in tasks], algorithm)
        seconds = time.perf_counter() - started
        return tuple(task.face(solution, algorithm, seconds) for task, solution in zip(tasks, solutions, strict=True))
