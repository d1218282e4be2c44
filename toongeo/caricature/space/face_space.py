"""The deformation space of a face model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.caricature.space.deformation_space import DeformationSpace
from toongeo.model.anatomy.parts import INNER_PARTS
from toongeo.model.default_model import default_model
from toongeo.model.morphable_model import MorphableModel

__all__ = ["FaceSpace", "face_space"]

_POOL = 150  # identities, of which the half that differs most is taken (section 5.1)
IDENTITIES = 75
EXPRESSIONS = 23
_SEED = 2018
# What no landmark sees and what is carried along with the lids and lips instead.


@dataclass(frozen=True, eq=False)
class FaceSpace:
    """A deformation space on the skin of a face model.

    Attributes
    ----------
    model : MorphableModel
    space : DeformationSpace
        Its reference is the model's mean at ``vertices``.
    vertices : (k,) int64
        Vertices of the model that the space deforms, ascending.

    Examples
    --------
    >>> import toongeo as tg
    >>> space = tg.face_space()
    >>> len(space.vertices) < len(space.model.mean)  # the skin alone: not what lies inside
    True
    >>> space.rows(space.vertices[[5, 9]])  # of vertices of the model, in the space
    array([5, 9])
    """

    model: MorphableModel
    space: DeformationSpace
    vertices: NDArray[np.int64]

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        if self.space.reference.shape != (len(self.vertices), 3):
            raise ValueError(
                f"vertices: expected one for each of the {len(self.space.reference)} of the space, "
                f"got {len(self.vertices)}"
            )
        read_only(self, "vertices")

    def rows(self, vertices: ArrayLike) -> NDArray[np.int64]:
        """Rows in the space of vertices of the model; ValueError if one is not in it."""
        wanted = np.asarray(vertices)
        rows = np.minimum(np.searchsorted(self.vertices, wanted), len(self.vertices) - 1)
        outside = self.vertices[rows] != wanted
        if outside.any():
            raise ValueError(f"vertices: expected vertices of the space, got {wanted[outside][0]}")
        return rows


def face_space(model: MorphableModel | None = None) -> FaceSpace:
    """The deformation space of a face model, built as the paper's: 75 identities and 23 expressions, 98 shapes.

    Of a pool of 150 random identities those 75 are taken that differ most from the mean face, and of the named
    expressions the 23 that move the face most. The identities are drawn with a fixed seed; the space of a model is
    always the same. It is kept for the last two models.

    Parameters
    ----------
    model : MorphableModel, optional
        `default_model` if None.

    Returns
    -------
    FaceSpace

    References
    ----------
    Wu et al. 2018, "Alive caricature from 2D to 3D", section 5.1.

    Examples
    --------
    >>> import toongeo as tg
    >>> space = tg.face_space()
    >>> space.model is tg.default_model(), space is tg.face_space()  # kept
    (True, True)
    """
    return _face_space(default_model() if model is None else model)


@lru_cache(maxsize=2)
def _face_space(model: MorphableModel) -> FaceSpace:
    vertices = _skin(model)
    inside = np.isin(model.faces, vertices).all(axis=1)
    V = model.mean[vertices]
    principal = model.principal_modes
    coefficients = np.random.default_rng(_SEED).standard_normal((_POOL, len(principal)))
    modes = principal[:, vertices].reshape(len(principal), -1)
    identities = _farthest((coefficients.astype(np.float32) @ modes).reshape(_POOL, -1, 3), IDENTITIES)
    expressions = _farthest(model.expression[: model.n_named, vertices], EXPRESSIONS)
    shapes = V + np.concatenate([identities, expressions]).astype(np.float64)
    space = DeformationSpace.from_meshes(V, np.searchsorted(vertices, model.faces[inside]), shapes, align=False)
    return FaceSpace(model, space, vertices)


def _skin(model: MorphableModel) -> NDArray[np.int64]:
    """Vertices in triangles that belong to no inner part."""
    inner = np.any([model.region(name) for name in INNER_PARTS], axis=0)
    return np.unique(model.faces[~inner[model.faces].any(axis=1)])


def _farthest(displacements: NDArray[np.float32], count: int) -> NDArray[np.float32]:
    """The ``count`` displacements (k, n, 3) of largest size, in their order."""
    sizes = (displacements.astype(np.float64) ** 2).sum(axis=(1, 2))
    return displacements[np.sort(np.argsort(-sizes, kind="stable")[:count])]
