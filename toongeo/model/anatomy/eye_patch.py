"""The skin around an eye."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from toongeo._read_only import read_only, restored
from toongeo.geometry import LaplacianAligner, laplacian_align
from toongeo.model import MorphableModel

__all__ = ["EyePatch", "eye_patch", "sagitta"]


@dataclass(frozen=True, eq=False)
class EyePatch:
    """The skin around one eye, up to the inner edges of its lids.

    Attributes
    ----------
    vertices : (k,) int64
        Sorted.
    faces : (m, 3) int64
        Triangles among them, rows of ``vertices``.
    border : (b,) int64
        Those of ``vertices`` where the patch is joined to the rest of the skin.
    """

    vertices: np.ndarray
    faces: np.ndarray
    border: np.ndarray

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "vertices", "faces", "border")

    def pulled(self, V: np.ndarray, anchors: np.ndarray, targets: np.ndarray) -> np.ndarray:
        """Where the patch of a head V (n, 3) comes to lie, (k, 3), if some of its vertices go to targets.

        By Laplacian deformation; the border stays.
        """
        inner = ~np.isin(anchors, self.border)
        return laplacian_align(
            V[self.vertices],
            self.faces,
            np.searchsorted(self.vertices, anchors[inner]),
            targets[inner],
            weight=np.inf,
            fixed=np.searchsorted(self.vertices, self.border),
        )

    def followed(self, anchors: np.ndarray, moves: np.ndarray) -> np.ndarray:
        """How far the patch goes, (k, 3), if some of its vertices (a,) go by moves (a, 3).

        The same deformation: with uniform weights it depends on the mesh but not on its shape, and is kept for anchors
        that come again.
        """
        return _follower(self, tuple(anchors.tolist())).align(moves)


@lru_cache(maxsize=8)
def _follower(patch: EyePatch, anchors: tuple[int, ...]) -> LaplacianAligner:
    at = np.searchsorted(patch.vertices, anchors)
    fixed = np.setdiff1d(np.searchsorted(patch.vertices, patch.border), at)
    return LaplacianAligner(np.zeros((len(patch.vertices), 3)), patch.faces, at, weight=np.inf, fixed=fixed)


@lru_cache(maxsize=8)
def eye_patch(model: MorphableModel, side: str) -> EyePatch:
    """Patch of the "left" or "right" eye: the region ``eye_left`` or ``eye_right``.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> patch = eye_patch(default_model(), "left")
    >>> bool(patch.faces.max() + 1 == len(patch.vertices))
    True
    """
    skin = model.region(f"eye_{side}")
    inside = skin[model.faces].all(1)
    used, faces = np.unique(model.faces[inside], return_inverse=True)
    rest = ~inside & ~model.region(f"socket_{side}")[model.faces].any(1)
    return EyePatch(used, faces.reshape(-1, 3), np.intersect1d(used, model.faces[rest]))


def sagitta(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Squared length / 8 of the longest edge at each vertex, (n,), mm^2.

    Divided by the radius of a sphere it is how far such an edge with both ends on the sphere dips into it.
    """
    edges = model.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    length2 = ((V[edges[:, 0]] - V[edges[:, 1]]) ** 2).sum(1)
    longest = np.zeros(len(V))
    np.maximum.at(longest, edges.ravel(), np.repeat(length2, 2))
    return longest / 8
