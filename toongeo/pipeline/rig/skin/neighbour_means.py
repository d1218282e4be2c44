"""Means over the neighbours of vertices."""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel

__all__ = ["neighbour_means"]


@lru_cache(maxsize=4)
def neighbour_means(model: MorphableModel) -> sp.csr_array:
    """Mean over the neighbours of each vertex."""
    A = sp.csr_array(adjacency(model.faces, len(model.mean)), dtype=float)
    return sp.csr_array(sp.diags_array(1 / np.maximum(A.sum(1), 1)) @ A)
