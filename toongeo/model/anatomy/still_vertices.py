"""What no expression moves."""

from functools import lru_cache

import numpy as np

from toongeo.model import MorphableModel

__all__ = ["still_vertices"]

_MOVES_MM = 0.05  # what moves less than this in every expression is held still


@lru_cache(maxsize=4)
def still_vertices(model: MorphableModel) -> np.ndarray:
    """Vertices (p,) that no named expression moves: skull, neck, ears.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> still = still_vertices(model)
    >>> bool(model.region("scalp")[still].any()), bool(model.region("lips")[still].any())
    (True, False)
    """
    motion = np.abs(model.expression[: model.n_named]).max(axis=(0, 2), initial=0.0)
    still = np.flatnonzero(motion < _MOVES_MM)
    still.setflags(write=False)
    return still
