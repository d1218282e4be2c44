"""Where an expression moves the template, and where it does not."""

from functools import lru_cache

import numpy as np

from toongeo.model import MorphableModel

__all__ = ["motion_shares"]

# Of an expression's largest motion: up to the first a vertex is still, from the second it moves freely. On the template
# these are 0.1 mm and 1.3 mm of an opening jaw: a band of some ten millimetres in which drift fades out unseen. Chosen
# on 14, 21 and bad_guy by crossings in all 46: a band thrice as wide did no better (`benchmarks/mouths.py`).
_STILL, _FREE = 0.002, 0.032


@lru_cache(maxsize=4)
def motion_shares(model: MorphableModel) -> np.ndarray:
    """How far each named expression may move each vertex of a face: by the motion of the template's own.

    Parameters
    ----------
    model : MorphableModel

    Returns
    -------
    (k, n) float32
        0 where the expression leaves the template alone, 1 where it clearly moves it, a smooth step between.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> jaw = motion_shares(model)[model.expression_index("jawOpen")]
    >>> float(jaw[model.landmarks[36:48]].max()), float(jaw[model.landmarks[66]])  # lids, lower lip
    (0.0, 1.0)
    """
    motion = np.linalg.norm(model.expression[: model.n_named], axis=2)
    largest = np.maximum(motion.max(1, keepdims=True, initial=0.0), np.finfo(np.float32).tiny)
    step = np.clip((motion / largest - _STILL) / (_FREE - _STILL), 0, 1)
    shares = (step * step * (3 - 2 * step)).astype(np.float32)
    shares.setflags(write=False)
    return shares
