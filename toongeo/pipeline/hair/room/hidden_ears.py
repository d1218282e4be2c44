"""Ears that hair covers."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.plane.depth_maps import silhouette
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane

__all__ = ["hidden_ears", "shrunken_ears"]

_SHOWN = 0.35  # of an ear's silhouette: with less skin in the picture it lies under hair
_LEFT = 0.25  # of a hidden ear's size is left
_ROOT_MM = 5.0  # from the root, the ear shrinks fully


def hidden_ears(
    face: AlignedFace, plane: WorkingPlane, skin: NDArray[np.bool_], hair: NDArray[np.bool_]
) -> tuple[str, ...]:
    """Regions ``ear_left``, ``ear_right`` of the ears over which the plane shows hair and little skin."""
    X, F = plane.of(face.vertices), face.faces
    front = silhouette(plane, X, F[(face.region("face") & ~face.region("ears"))[F].all(1)])
    hidden = []
    for name in ("ear_left", "ear_right"):
        ear = silhouette(plane, X, F[face.region(name)[F].all(1)]) & ~front
        if (skin & ear).sum() < _SHOWN * ear.sum() and (hair & ear).any():
            hidden.append(name)
    return tuple(hidden)


def shrunken_ears(face: AlignedFace, X: NDArray[np.floating], names: tuple[str, ...]) -> NDArray[np.floating]:
    """Displacement (n, 3) that draws the ears of these regions into their roots; X (n, 3) in any frame."""
    moved = np.zeros_like(X)
    F = face.faces
    for name in names:
        ear = face.region(name)
        border = F[ear[F].any(1) & ~ear[F].all(1)]
        root = X[np.unique(border[~ear[border]])]
        away = cKDTree(root).query(X[ear])[0]
        moved[ear] = (root.mean(0) - X[ear]) * ((1 - _LEFT) * np.clip(away / _ROOT_MM, 0, 1))[:, None]
    return moved
