"""The fitted face with no more of its expression than it bears without a fold.

Constants were chosen on heads of the model with mouths of twice their size (``benchmarks/alignment.py``).
"""

from dataclasses import replace

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry import self_intersections
from toongeo.pipeline.fit.face_fit import FaceFit

__all__ = ["unfolded_start"]

_SHARES = 0.8, 0.6, 0.4  # of the expression; the mouth must stay open, for a flow does not part lips that touch
_FEW = 5  # triangles that intersect; what an alignment closes, or nobody sees
_STRONG = 5.0  # sum of the named weights of mouth and jaw; fits that fold have 7 and more, most pictures 1 to 5


def unfolded_start(fit: FaceFit) -> FaceFit:
    """The fit from which an alignment begins.

    A mouth that is drawn as wide as the face is fitted with all that opens and stretches mouths at once, and the skin
    beside such a sum of expressions folds. The flow that follows keeps what is folded, but it can open a mouth further
    as well as the expressions do. So where the fitted face intersects itself, the expression is taken back until it
    does not: to 80, 60 or 40 %, or to where it does the least.

    Parameters
    ----------
    fit : FaceFit

    Returns
    -------
    FaceFit
        The same object where it is sound. Whoever takes the expression out of the aligned face again must take out that
        of this fit: no more than went in.
    """
    model = fit.model
    named = fit.expression[: model.n_named]
    mouth = [name.startswith(("mouth", "jaw")) for name in model.expression_names[: model.n_named]]
    if named[mouth].sum() < _STRONG:
        return fit
    front = fit.faces[model.region("face")[fit.faces].all(1)]
    best, fewest = fit, _crossings(fit.vertices, front)
    for share in _SHARES:
        if fewest <= _FEW:
            break
        less = replace(fit, expression=share * fit.expression)
        crossings = _crossings(less.vertices, front)
        if crossings < fewest:
            best, fewest = less, crossings
    return best


def _crossings(V: Floats, F: np.ndarray) -> int:
    return len(np.unique(self_intersections(V, F)))
