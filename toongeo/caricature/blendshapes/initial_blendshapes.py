"""Expressions of a caricature from those of the normal face behind it (Chen et al. 2020, section 3.2.2).

Constants were judged on faces of the deformation space and four pictures (``benchmarks/caricature_expressions.py``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.caricature.blendshapes.landmark_mapper import PartMapper
from toongeo.caricature.blendshapes.sparse_expression import sparse_expression
from toongeo.caricature.caricature_fit import CaricatureFit
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.refitted_skin import refitted_skin
from toongeo.caricature.space.deformation_representation import deformation_representation
from toongeo.caricature.space.face_space import FaceSpace
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import landmarks_seen
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.protocols import HeadCamera, LandmarkMapper
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["InitialBlendshapes", "initial_blendshapes"]

_PRIOR = 1e-6  # of the fit to F+(L), which is a face of people: it should keep what F+ tells
_RIDGE = 1e-3  # of the mean diagonal: keeps weights of like shapes small
_STEPS = 2  # of Levenberg-Marquardt: the fit only starts the optimization
_FEW = 97  # every so many vertices tell whether shapes can be the same
_SAME = 1e-5  # largest difference of stretches at which a shape is one of the space's own


@dataclass(frozen=True, eq=False)
class InitialBlendshapes:
    """S(e_i) before they are optimized.

    Attributes
    ----------
    vertices : (1 + k, v, 3) float64, mm, model frame
        S(e_0), the neutral face, then one shape for each of the ``model.n_named`` expressions, at the vertices of the
        space.
    landmarks : (1 + k, 68, 2) float64, px
        L(e_i), to which they were fitted: where each landmark of the drawing goes.
    landmark_vertices : (1 + k, 68) int64
        The vertices that go there. The chin of an open mouth is another place of the skin than that of a closed one:
        a jaw point stands for what is the outline when the normal face has the expression, and moves as that does.
    source : CaricatureFit
        S(e_x).
    normal : FaceFit
        The normal face behind the source; its expression is e_x.
    """

    vertices: Floats
    landmarks: Floats
    landmark_vertices: NDArray[np.int64]
    source: CaricatureFit
    normal: FaceFit

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "vertices", "landmarks", "landmark_vertices")


def initial_blendshapes(
    source: CaricatureFit, landmarks: ArrayLike, *, mapper: LandmarkMapper | None = None, scheme: str = "ibug68"
) -> InitialBlendshapes:
    """Neutral face and named expressions of a caricature, one reconstruction each (Eq. 2-3).

    The landmarks are mapped to a normal face, which is fitted; its expression is exchanged, its landmarks are
    projected and mapped back, and the caricature is fitted to them with the camera of the source. Each fit begins at
    the weights of the source with this expression's added.

    Parameters
    ----------
    source : CaricatureFit
        Fitted to ``landmarks``.
    landmarks : (68, 2) array_like, px
        NaN rows are missing.
    mapper : LandmarkMapper, optional
        `PartMapper` of the source's model if None.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    InitialBlendshapes

    Raises
    ------
    ValueError
        If the landmarks are malformed, or the mapper gives something else than 68 finite points.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> model = tg.default_model()
    >>> names = ("jawOpen", "mouthSmileLeft")  # two of its expressions; each is a fit of its own
    >>> deltas = model.expression[[model.expression_index(name) for name in names]]
    >>> few = replace(model, expression=deltas, expression_names=names, n_named=2)
    >>> face = tg.exaggerate(tg.fit_3dmm(None, landmarks, model=few), 0.3)  # or tg.fit_caricature
    >>> shapes = tg.initial_blendshapes(face, face.project(face.vertices[face.landmark_vertices]))
    >>> shapes.vertices.shape, shapes.landmarks.shape  # the neutral face, then the expressions
    ((3, 12606, 3), (3, 68, 2))
    """
    drawn = ibug_landmarks(landmarks, scheme)
    mapper = PartMapper(source.model) if mapper is None else mapper
    points, context = mapper.to_normal(drawn)
    points = _checked(points, "to_normal")
    fit = fit_3dmm(None, points, model=source.model, prior_weight=_PRIOR)
    normal = sparse_expression(fit, points)
    at, edited = _edited(normal, points)
    targets = np.stack([_checked(mapper.to_caricature(p, context), "to_caricature") for p in edited])
    weights = _expression_weights(source.space)
    rest = source.w - np.tensordot(normal.expression[: len(weights)], weights, 1)
    shapes = [_reconstructed(source, *goal) for goal in zip([rest, *(rest + weights)], at, targets, strict=True)]
    return InitialBlendshapes(np.stack(shapes), targets, at, source, normal)


def _edited(normal: FaceFit, points: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Landmark vertices (1 + k, 68) and landmarks (1 + k, 68, 2) of the normal face with each expression (Eq. 3).

    What the fit left of the landmarks stays.
    """
    model, basis = normal.model, landmark_basis(normal.model)
    modes = model.expression[:, basis.vertices].astype(np.float64)
    own, rotation = normal.vertices[basis.vertices], _rotation(normal.camera)
    rest = own - np.tensordot(normal.expression, modes, 1)
    faces = np.concatenate([rest[None], rest + modes[: model.n_named]])
    at = np.stack([landmarks_seen(basis, face, rotation) for face in faces])
    rows = np.searchsorted(basis.vertices, at)
    moves = [normal.project(face[row]) - normal.project(own[row]) for face, row in zip(faces, rows, strict=True)]
    return at, points + np.stack(moves)


def _rotation(camera: HeadCamera) -> Floats:
    assert isinstance(camera, ScaledOrthographicCamera)  # as of every fit_3dmm
    return camera.rotation


def _reconstructed(source: CaricatureFit, w: Floats, at: NDArray[np.int64], target: Floats) -> Floats:
    """Vertices (v, 3) of the space fitted to landmarks at some vertices, beginning at the source with other weights."""
    space, vertices = source.space, source.vertices.copy()
    vertices[space.vertices] += space.space.vertices(w) - space.space.vertices(source.w)
    start = replace(source, w=w, vertices=vertices, landmark_vertices=at)
    options = CaricatureOptions(noise=0)  # these landmarks are made, not measured
    return refitted_skin(start, target + source_offsets(source, at), options)


def source_offsets(source: CaricatureFit, at: NDArray[np.int64]) -> Floats:
    """How far (68, 2), px, some vertices are seen from the landmark vertices of the source."""
    return source.project(source.vertices[at]) - source.project(source.vertices[source.landmark_vertices])


@lru_cache(maxsize=2)
def _expression_weights(space: FaceSpace) -> Floats:
    """Weights (k, 2, l) in the space of the named expressions of the mean face."""
    model, inner = space.model, space.space
    shapes = model.mean[space.vertices] + model.expression[: model.n_named, space.vertices].astype(np.float64)
    found = np.zeros((len(shapes), 2, len(inner.rotations)))
    for w, shape in zip(found, shapes, strict=True):
        if not np.ptp(shape - inner.reference, axis=0).any():
            continue
        _, stretch = deformation_representation(inner.rings, shape)
        few = slice(None, None, _FEW)  # all of a hundred shapes are compared only where these agree
        near = np.flatnonzero(np.abs(inner.stretches[..., few] - stretch[..., few]).max(axis=(1, 2)) < _SAME)
        same = near[np.abs(inner.stretches[near] - stretch).max(axis=(1, 2)) < _SAME]
        if len(same):
            w[:, same[0]] = 1.0  # it is one of those that make the space
        else:
            w[:] = inner.fit(shape, ridge=_RIDGE, iterations=_STEPS).w
    return found


def _checked(points: ArrayLike, name: str) -> Floats:
    array = np.asarray(points, np.float64)
    if array.shape != (68, 2) or not np.isfinite(array).all():
        raise ValueError(f"mapper: expected {name} to give (68, 2) finite numbers, got shape {array.shape} or NaN")
    return array
