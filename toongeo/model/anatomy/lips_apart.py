"""How far a mouth is open."""

import numpy as np
from scipy.spatial import cKDTree

from toongeo.model import MorphableModel
from toongeo.model.anatomy.lip_line import lip_line

__all__ = ["lips_apart"]


def lips_apart(model: MorphableModel, V: np.ndarray) -> float:
    """Mean distance of the lines where the lips end, each to the nearest point of the other, in widths of the mouth.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> jaw = model.mean + model.expression[model.expression_index("jawOpen")]
    >>> lips_apart(model, model.mean) < 0.02 < 0.2 < lips_apart(model, jaw)
    True
    """
    line = lip_line(model)
    near = [cKDTree(V[b]).query(V[a])[0].mean() for a, b in ((line.upper, line.lower), (line.lower, line.upper))]
    return float(np.mean(near) / np.linalg.norm(V[line.upper[-1]] - V[line.upper[0]]))
