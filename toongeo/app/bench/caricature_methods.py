"""The methods that Wu et al. 2018 compare in section 5.2."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Protocol

import igl
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.caricature import BilinearModel, LinearFit, bilinear_fit, caricatured_modes, linear_fit
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.model.anatomy.parts import TEETH_AND_TONGUE
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline import align_face, fit_3dmm
from toongeo.protocols import HeadCamera

__all__ = ["FoundFace", "arap_fit", "caricature_methods"]

_REGULARIZATION = 3000.0  # Eq. 17
_ROUNDS = 20  # of ARAP


class FoundFace(Protocol):
    """A face that some method found."""

    @property
    def vertices(self) -> Floats: ...

    @property
    def camera(self) -> HeadCamera: ...

    @property
    def landmark_vertices(self) -> NDArray[np.int64]: ...


def caricature_methods(model: MorphableModel) -> Mapping[str, Callable[[Floats], FoundFace]]:
    """Name -> method that finds a face for landmarks (68, 2), px; NaN rows are missing.

    The paper's four baselines before and after ARAP, the fit of the pipeline with ARAP, its fine stage, and ours.
    """
    linear = np.concatenate([model.identity, model.expression])
    mean, caricatured = caricatured_modes(model, np.random.default_rng(0))
    bilinear = BilinearModel.from_model(model, np.random.default_rng(0))
    plain: dict[str, Callable[[Floats], FoundFace]] = {
        "3DMM": lambda q: linear_fit(q, model, model.mean, linear, _REGULARIZATION),
        "3DMM(-)": lambda q: linear_fit(q, model, model.mean, linear, 0.0),
        "bilinear": lambda q: bilinear_fit(q, model, bilinear),
        "caricatured 3DMM": lambda q: linear_fit(q, model, mean, caricatured, _REGULARIZATION),
        "fit_3dmm": lambda q: fit_3dmm(None, q, model=model),
    }
    bent = {f"{name} + ARAP": partial(_bent, fit, model) for name, fit in plain.items() if name != "3DMM(-)"}
    return {
        **plain,
        **bent,
        "align_face": lambda q: align_face(fit_3dmm(None, q, model=model), q),
        "fit_caricature": lambda q: fit_caricature(None, q),
    }


def arap_fit(face: FoundFace, model: MorphableModel, landmarks: Floats) -> LinearFit:
    """As-rigid-as-possible deformation (libigl) of a face to landmarks (68, 2), px, at the depth of the face.

    Parts without a landmark, teeth and tongue, stay.
    """
    names = TEETH_AND_TONGUE
    loose = np.any([model.region(name) for name in names], axis=0)
    kept, seen = np.flatnonzero(~loose), np.isfinite(landmarks).all(axis=1)
    F = np.searchsorted(kept, model.faces[~loose[model.faces].any(axis=1)])
    anchors, first = np.unique(face.landmark_vertices[seen], return_index=True)
    targets = face.camera.unproject(landmarks[seen][first], face.camera.depth(face.vertices[anchors]))
    data = igl.ARAPData()
    data.max_iter = _ROUNDS
    V = face.vertices[kept]
    igl.arap_precomputation(V, F, 3, np.searchsorted(kept, anchors).astype(np.int32), data)
    deformed = face.vertices.copy()
    deformed[kept] = igl.arap_solve(targets, data, V)
    return LinearFit(deformed, face.camera, face.landmark_vertices)


def _bent(fit: Callable[[Floats], FoundFace], model: MorphableModel, landmarks: Floats) -> LinearFit:
    return arap_fit(fit(landmarks), model, landmarks)
