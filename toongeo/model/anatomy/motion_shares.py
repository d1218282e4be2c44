"""Where an expression moves the template, and where it does not."""

from functools import lru_cache

import numpy as np

from toongeo.model import MorphableModel

__all__ = ["motion_shares"]

# Of an expression's largest motion: up to the first a vertex is still, from the second it moves freely. Chosen by
# crossings of the skin on bad_guy, beethoven, blue_girl, manga_girl, the blonde girl, 14 and 21: around the mouth a
# wider band folds the lips, elsewhere a narrower one the cheeks.
_STILL, _FREE, _FREE_OF_MOUTH = 0.002, 0.2, 0.032
_MOUTH = ("jaw", "mouth", "tongue")


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
    names = model.expression_names[: model.n_named]
    free = np.array([_FREE_OF_MOUTH if name.startswith(_MOUTH) else _FREE for name in names]).reshape(-1, 1)
    step = np.clip((motion / largest - _STILL) / (free - _STILL), 0, 1)
    shares = (step * step * (3 - 2 * step)).astype(np.float32)
    shares.setflags(write=False)
    return shares
