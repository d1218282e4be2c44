"""A skull that is lower than the hair on it."""

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane

__all__ = ["lowered_crown"]

Floats = NDArray[np.floating]
_UNDER_MM = 4.0  # from the top of the hair to the skull
_LOWEST = 0.55  # of the height above the brows is left at least: drawings have low heads, not none


def lowered_crown(face: AlignedFace, plane: WorkingPlane, hair: NDArray[np.bool_], crown: NDArray[np.bool_]) -> Floats:
    """Displacement (n, 3), mm, in the plane's frame, that brings the crown below the top of the hair.

    It grows with the square of the height above the brows, which keep their place; the skull becomes shallower, too.
    """
    X = plane.of(face.vertices)
    scalp = face.model.regions["scalp"]
    brows, top = X[face.landmark_vertices[17:27], 1].max(), X[scalp, 1].max()
    columns = np.flatnonzero(crown.any(0))
    middle = columns[len(columns) // 4 : 3 * len(columns) // 4 + 1]
    topped = hair[:, middle]
    topped = topped[:, topped.any(0)]
    moved = np.zeros_like(X)
    if not topped.size:
        return moved
    highest = len(hair) - 1 - topped[::-1].argmax(0)
    hair_top = plane.points(np.array([0.0, np.percentile(highest, 40)]))[1]
    left = float(np.clip((hair_top - _UNDER_MM - brows) / (top - brows), _LOWEST, 1.0))
    height = np.clip((X[:, 1] - brows) / (top - brows), 0, 1)
    moved[:, 1] = -(1 - left) * (top - brows) * height**2
    moved[:, 2] = -(1 - left) * height**2 * (X[:, 2] - np.median(X[scalp, 2]))
    return moved
