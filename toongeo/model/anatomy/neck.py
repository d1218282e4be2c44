"""What a head turns about, and where it ends."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from toongeo.arrays import Integers
from toongeo.model import MorphableModel

__all__ = ["NECK_MM", "neck_rim"]

# Model frame: the bone of the head, as in humanoid_bones.csv.
NECK_MM = np.array([0.0, -85.0, -80.0])
NECK_MM.flags.writeable = False


@lru_cache(maxsize=4)
def neck_rim(model: MorphableModel) -> Integers | None:
    """Vertices around the hole at the end of the neck, in the order of the triangles there; None if there is none."""
    if not model.has("neck"):
        return None
    directed = np.vstack([model.faces[:, [0, 1]], model.faces[:, [1, 2]], model.faces[:, [2, 0]]])
    inside = model.region("neck")[directed].all(axis=1)
    ways = {(int(a), int(b)) for a, b in directed[inside]}
    after = {a: b for a, b in ways if (b, a) not in ways}
    if not after:
        return None
    loop = [min(after)]
    while (following := after.get(loop[-1])) is not None and following != loop[0]:
        loop.append(following)
        if len(loop) > len(after):
            return None
    return np.array(loop) if len(loop) == len(after) else None
