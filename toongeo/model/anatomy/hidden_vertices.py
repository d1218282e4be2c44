"""What lies behind the lids and lips of a model.

Constants were judged on ICT-FaceKit's head and the template (``benchmarks/register.py``), on no picture.
"""

import numpy as np
from scipy.spatial import cKDTree

from toongeo.model.anatomy.rims import opening_rim
from toongeo.model.morphable_model import MorphableModel

__all__ = ["hidden_vertices"]

# Parts of the template that a head may lack or have in another form, and how far behind their rims (mm) they begin: the
# inner sides of lids and lips are looked for on the head.
_HIDDEN = {
    "socket_left": 3.0,
    "socket_right": 3.0,
    "mouth_cavity": 8.0,
    "teeth_upper": 0,
    "teeth_lower": 0,
    "tongue": 0,
}


def hidden_vertices(model: MorphableModel) -> np.ndarray:
    """Mask (n,) of the parts of a model that lie behind lids and lips."""
    mask = np.zeros(len(model.mean), bool)
    for name, depth in _HIDDEN.items():
        if name in model.regions:
            inside = np.flatnonzero(model.regions[name])
            rim = model.mean[opening_rim(model, name)]
            mask[inside] = cKDTree(rim).query(model.mean[inside])[0] > depth if len(rim) else True
    return mask
