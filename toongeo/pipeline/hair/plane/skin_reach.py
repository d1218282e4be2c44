"""How far the skin comes out in any expression."""

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.rig import Rig

__all__ = ["skin_reach"]

_MARGIN = 1.2  # of the strongest expression alone: several at once reach farther


def skin_reach(face: AlignedFace, rig: Rig) -> NDArray[np.float64]:
    """Vertices (n, 3), mm, model frame, of the face with its skin moved out along its normals by the largest share
    that any expression of the rig has along them. Lips, which no hair touches, stay."""
    rows = np.flatnonzero(face.region("skin") & ~face.region("lips"))
    normals = face.normals[rows]
    across = np.ascontiguousarray(normals.T, np.float32)
    reach = np.zeros(len(rows), np.float32)
    for delta in rig.deltas:
        moved = delta[rows]
        np.maximum(reach, sum(moved[:, k] * across[k] for k in range(3)), out=reach)
    rest = ((rig.neutral - face.vertices)[rows] * normals).sum(1)
    vertices = face.vertices.copy()
    vertices[rows] += normals * (np.maximum(rest, 0) + _MARGIN * reach)[:, None]
    return vertices
