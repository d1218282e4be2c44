"""A rig whose expressions are those of a caricature (Chen et al. 2020, section 3.2).

Constants were judged on faces of the deformation space and four pictures (``benchmarks/caricature_expressions.py``).
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats
from toongeo.caricature.align_caricature import caricature_of
from toongeo.caricature.blendshapes.initial_blendshapes import initial_blendshapes
from toongeo.caricature.blendshapes.optimize_blendshapes import (
    BlendshapeWeights,
    displacement_masks,
    optimize_blendshapes,
)
from toongeo.caricature.blendshapes.restore_similarities import restore_similarities
from toongeo.caricature.blendshapes.weights_of_expression import weights_of_expression
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.caricature.inner_parts import with_inner_parts
from toongeo.caricature.space.face_space import FaceSpace, face_space
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.rig.build_rig import build_rig
from toongeo.pipeline.rig.rig import Rig, RigReport
from toongeo.pipeline.rig.split_gaze import split_gaze
from toongeo.protocols import LandmarkMapper
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["caricature_rig"]

# How far a drawing's lids are apart is a trait, not an expression: they are closed by contact, from where they are.
_TRAITS = ("eyeBlink", "eyeWide")
_STILL = 0.02  # of the largest motion: what moves no more in the normal face is still
_WEIGHTS = BlendshapeWeights(saturation=0.2, softness=6.0)  # mm


def caricature_rig(
    face: AlignedFace,
    landmarks: ArrayLike,
    *,
    mapper: LandmarkMapper | None = None,
    weights: BlendshapeWeights | None = None,
    scheme: str = "ibug68",
) -> Rig:
    """Named expressions in the manner of the drawing: as `build_rig`, but each is reconstructed and optimized.

    `initial_blendshapes` of the drawing, `optimize_blendshapes` and `restore_similarities`, and the inside of the
    mouth from deformation transfer, carried along with the new lips. Residuals are taken against the neutral
    face S(e_0) and not against the picture's S(e_x), as the deltas of a rig are: otherwise a blink would also undo a
    part of the smile that the picture shows. Where the picture is neutral, the two are the same.

    Parameters
    ----------
    face : AlignedFace
        As it is in the picture.
    landmarks : (68, 2) array_like, px
        Of the picture; NaN rows are missing.
    mapper : LandmarkMapper, optional
        `PartMapper` if None.
    weights : BlendshapeWeights, optional
        Of the optimization. If None, its defaults with masks that hold still only what hardly moves in the normal
        face.
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    Rig
        ``pose`` is the picture's expression: ``rig.vertices(rig.pose)`` is the face. Lids count as neutral the way
        they are drawn.

    Raises
    ------
    ValueError
        If the landmarks are malformed.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> model = tg.default_model()
    >>> names = ("jawOpen", "mouthSmileLeft")  # two of its expressions; all of them take a quarter of a minute
    >>> deltas = model.expression[[model.expression_index(name) for name in names]]
    >>> few = replace(model, expression=deltas, expression_names=names, n_named=2)
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks, model=few), landmarks)
    >>> rig = tg.caricature_rig(face, landmarks)
    >>> rig.names, rig.deltas.shape
    (('jawOpen', 'mouthSmileLeft'), (2, 19057, 3))
    """
    started = time.perf_counter()
    landmarks = ibug_landmarks(landmarks, scheme)
    model, space = face.model, face_space(face.model)
    parallel = isinstance(face.fit.camera, ScaledOrthographicCamera)
    source = caricature_of(face.fit, landmarks) if parallel else fit_caricature(None, landmarks, space=space)
    initial = initial_blendshapes(source, landmarks, mapper=mapper)
    D_normal = model.expression[: model.n_named, space.vertices].astype(np.float64)
    D = initial.vertices[1:] - initial.vertices[0]
    weights = _WEIGHTS if weights is None else weights
    best = optimize_blendshapes(D, D_normal, face.vertices[space.vertices], space.space.faces, weights)
    # Restoring mixes in a little of other expressions: not where this one is still.
    share = np.clip(displacement_masks(D_normal) / _STILL - 1.0, 0.0, 1.0)[:, :, None]
    best += share * (restore_similarities(best, D_normal) - best)
    deltas = _with_inner_parts(space, face, best)
    pose = weights_of_expression(initial.normal.expression, model)
    named = model.expression_names[: model.n_named]
    pose[[name.startswith(_TRAITS) for name in named]] = 0.0
    names, deltas, gaze = split_gaze(named, deltas)
    pose = pose[[name in names for name in named]]
    return Rig(
        names=names,
        neutral=face.vertices - np.tensordot(pose, deltas.astype(np.float64), 1),
        deltas=deltas,
        gaze=gaze,
        pose=pose,
        report=RigReport(time.perf_counter() - started),
    )


def _with_inner_parts(space: FaceSpace, face: AlignedFace, D: Floats) -> NDArray[np.float32]:
    """Deltas (k, n, 3) of the whole face for those (k, v, 3) of the skin."""
    rig = build_rig(face)
    transferred = {**dict(zip(rig.names, rig.deltas, strict=True)), **dict(zip(GAZE_NAMES, rig.gaze, strict=True))}
    names = face.model.expression_names[: face.model.n_named]
    deltas = np.empty((len(names), *face.vertices.shape), np.float32)
    skin = face.vertices[space.vertices]
    for k, (name, moved) in enumerate(zip(names, D, strict=True)):
        V = with_inner_parts(space, face.vertices + transferred[name], skin + moved, tuck=False)
        deltas[k] = V - face.vertices
    return deltas
