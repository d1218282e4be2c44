"""Shapes of the gaze apart from expressions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from toongeo.model.anatomy.gaze import GAZE_NAMES

__all__ = ["split_gaze"]


def split_gaze(names: Sequence[str], deltas: np.ndarray) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Names and displacements (k, n, 3) of expressions, and those (8, n, 3) of the gaze, 0 where they are not given.

    Examples
    --------
    >>> names, deltas, gaze = split_gaze(["jawOpen", GAZE_NAMES[2]], np.ones((2, 1, 3), np.float32))
    >>> names, deltas.shape, gaze[:, 0, 0]
    (('jawOpen',), (1, 1, 3), array([0., 0., 1., 0., 0., 0., 0., 0.], dtype=float32))
    """
    gaze = np.zeros((len(GAZE_NAMES), *deltas.shape[1:]), np.float32)
    own = [k for k, name in enumerate(names) if name not in GAZE_NAMES]
    for name, delta in zip(names, deltas, strict=True):
        if name in GAZE_NAMES:
            gaze[GAZE_NAMES.index(name)] = delta
    return tuple(names[k] for k in own), deltas if len(own) == len(deltas) else deltas[own], gaze
