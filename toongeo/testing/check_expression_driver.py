"""Whether something is an `ExpressionDriver`."""

from __future__ import annotations

from typing import Any

import numpy as np

from toongeo.model import default_model
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.protocols import ExpressionDriver
from toongeo.testing.example import require

__all__ = ["check_expression_driver"]


def check_expression_driver(driver: ExpressionDriver, recording: Any, *, fps: float = 30.0) -> None:
    """Read a recording by a driver.

    Parameters
    ----------
    driver : ExpressionDriver
    recording : Any
        What it reads.
    fps : float

    Raises
    ------
    AssertionError
        If names are not those of expressions and directions of gaze, each once; weights are not (frames, names) in
        [0, 1]; or others come the second time.

    Examples
    --------
    >>> from toongeo import ArkitDriver
    >>> check_expression_driver(ArkitDriver(), np.full((4, 52), 0.5))
    """
    model = default_model()
    known = {*model.expression_names[: model.n_named], *GAZE_NAMES}
    names = driver.names
    require(isinstance(names, tuple) and len(set(names)) == len(names), "names: expected a tuple, each name once")
    unknown = [name for name in names if name not in known]
    require(not unknown, f"names: expected expressions of the rig or directions of gaze, got {', '.join(unknown)}")
    weights = np.asarray(driver.frames(recording, fps))
    fits = weights.ndim == 2 and weights.shape[1] == len(names) and len(weights) > 0
    require(fits, f"frames: expected (frames, {len(names)}), got {weights.shape}")
    require(np.isfinite(weights).all() and weights.min() >= 0 and weights.max() <= 1, "frames: expected [0, 1]")
    require(np.array_equal(driver.frames(recording, fps), weights), "frames: expected the same a second time")
