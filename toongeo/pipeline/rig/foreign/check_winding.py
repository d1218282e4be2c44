"""A head that is turned inside out, told before it is registered."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from toongeo.geometry import vertex_normals
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel
from toongeo.model.ibug68 import INNER

__all__ = ["check_winding"]


def check_winding(V: np.ndarray, F: np.ndarray, points: np.ndarray, model: MorphableModel) -> None:
    """Refuse a head (n, 3), (m, 3) whose surface at its landmarks (68, 3) faces the other way than the model's.

    Raises
    ------
    ValueError
        If the normals at most of the inner landmarks point into the head.
    """
    inner = INNER[np.isfinite(points[INNER]).all(1)]
    own = model.landmarks[inner]
    _, rotation, _ = similarity(model.mean[own], points[inner])
    expected = vertex_normals(model.mean, model.faces)[own] @ rotation.T
    used = np.unique(F)
    nearest = used[cKDTree(V[used]).query(points[inner])[1]]
    agreement = (vertex_normals(V, F)[nearest] * expected).sum(1)
    if np.median(agreement) < 0:
        raise ValueError(
            f"F: expected triangles counter-clockwise from outside, got ones that face into the head at "
            f"{(agreement < 0).sum()} of {len(inner)} landmarks"
        )
