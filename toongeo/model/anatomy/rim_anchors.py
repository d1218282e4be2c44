"""Anchors along the rims of eyes and lips, between the landmarks."""

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from toongeo.geometry.polyline import arc_length
from toongeo.model import MorphableModel
from toongeo.model.anatomy.rims import rim_paths
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS

__all__ = ["rim_anchors"]


def rim_anchors(model: MorphableModel, displacement: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices on the lid and lip rims between landmarks, and how they should move if the landmarks move so.

    A landmark moves one vertex; what lies between two of them follows only loosely. Rims are curves that the drawing
    shows, so the vertices along each take the displacement interpolated between its landmarks by arc length: by cubic
    splines along lids, which are round, and by monotone ones along lips, which touch and must not overshoot.

    Parameters
    ----------
    model : MorphableModel
    displacement : (68, d) float
        Of the landmarks, in any frame; NaN rows are missing, and the rim next to them is left free.

    Returns
    -------
    vertices : (k,) int64
        None of them a landmark vertex, none twice.
    displacement : (k, d) float64
    """
    seen = np.isfinite(displacement).all(1)
    vertices, moves = [], []
    for name, (path, knots) in rim_paths(model).items():
        rim = LID_RIMS.get(name) or LIP_RIMS[name]
        known = [i for i, landmark in enumerate(rim) if seen[landmark]]
        if len(known) < 2:
            continue
        length = arc_length(model.mean[path])
        values = displacement[[rim[i] for i in known]]
        interpolator = CubicSpline if name in LID_RIMS and len(known) > 2 else PchipInterpolator
        first, last = knots[known[0]], knots[known[-1]]
        between = np.setdiff1d(np.arange(first, last + 1), knots)
        vertices.append(path[between])
        moves.append(interpolator(length[knots[known]], values)(length[between]))
    if not vertices:
        return np.zeros(0, np.int64), np.zeros((0, displacement.shape[1]))
    found, first_at = np.unique(np.concatenate(vertices), return_index=True)
    free = ~np.isin(found, model.landmarks)
    return found[free], np.concatenate(moves)[first_at][free]
