"""A model's mesh in the shape of a head from elsewhere.

Constants were judged on ICT-FaceKit's head and the template (``benchmarks/register.py``), on no picture.
"""

from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only, restored
from toongeo.geometry.nonrigid_register import RegisteredMesh, nonrigid_register
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel
from toongeo.model.anatomy.hidden_vertices import hidden_vertices
from toongeo.model.anatomy.rim_anchors import rim_anchors
from toongeo.model.anatomy.straighten_teeth import PARTS, straighten_teeth
from toongeo.model.ibug68 import INNER
from toongeo.pipeline.align.align_face import AlignedFace, AlignReport
from toongeo.pipeline.fit.face_fit import FaceFit, FitReport
from toongeo.render import ScaledOrthographicCamera

__all__ = ["RegisteredFace", "register_face"]

_RIM_WEIGHT = 0.05  # of a landmark's: what lies between two of them on a rim is interpolated


@dataclass(frozen=True, eq=False)
class RegisteredFace:
    """A foreign head as a face of a model.

    Attributes
    ----------
    face : AlignedFace
        Model frame, mm.
    registration : RegisteredMesh
    scale, rotation, shift : float, (3, 3), (3,)
        ``scale * x @ rotation.T + shift`` takes points of the model frame to the foreign one.
    """

    face: AlignedFace
    registration: RegisteredMesh
    scale: float
    rotation: np.ndarray
    shift: np.ndarray

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "rotation", "shift")

    def to_foreign(self, vectors: np.ndarray) -> np.ndarray:
        """Displacements (..., 3), mm, model frame, in the foreign frame."""
        return np.asarray(self.scale * vectors @ self.rotation.T)


def register_face(V: np.ndarray, F: np.ndarray, points: np.ndarray, model: MorphableModel) -> RegisteredFace:
    """Lay the mean of a model on a head of another topology.

    The 51 inner landmarks and, more softly, the rims of lids and lips between them guide
    :func:`toongeo.nonrigid_register`. Jaw points do not: they lie on an outline that depends on the view, and
    every model has them elsewhere. The inside of sockets and mouth is taken along, teeth keep their form.

    Parameters
    ----------
    V : (n, 3) float64
        The head at rest, any unit and pose.
    F : (m, 3) int64
    points : (68, 3) float64
        Its landmarks, same frame; NaN rows are missing.
    model : MorphableModel

    Returns
    -------
    RegisteredFace

    Raises
    ------
    ValueError
        As :func:`toongeo.nonrigid_register`.
    """
    inner = np.isfinite(points).all(1) & np.isin(np.arange(len(points)), INNER)
    scale, rotation, shift = similarity(model.mean[model.landmarks[inner]], points[inner])
    wanted = np.where(inner[:, None], (points - shift) @ rotation / scale, np.nan)
    rim, moves = rim_anchors(model, wanted - model.mean[model.landmarks])
    rim_points = scale * (model.mean[rim] + moves) @ rotation.T + shift
    registration = nonrigid_register(
        model.mean,
        model.faces,
        V,
        F,
        np.r_[model.landmarks[inner], rim],
        np.vstack([points[inner], rim_points]),
        fitted=~hidden_vertices(model),
        landmark_weight=np.r_[np.ones(inner.sum()), np.full(len(rim), _RIM_WEIGHT)],
    )
    vertices = (registration.vertices - shift) @ rotation / scale
    if all(name in model.regions for name in PARTS):
        vertices = straighten_teeth(model, model.mean, vertices)
    camera = ScaledOrthographicCamera(1.0, np.eye(3), np.zeros(2))
    fit = FaceFit(
        identity=np.zeros(len(model.identity)),
        expression=np.zeros(len(model.expression)),
        camera=camera,
        landmark_vertices=model.landmarks,
        model=model,
        report=FitReport("none", "the mean face", 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, (), 0.0),
    )
    face = AlignedFace(vertices, camera, model.landmarks, model, fit, AlignReport())
    return RegisteredFace(face, registration, scale, rotation, shift)
