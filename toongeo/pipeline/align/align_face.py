"""The coarse face deformed onto the landmarks of the picture."""

import time
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from toongeo._read_only import read_only
from toongeo.geometry import laplacian_align, vertex_normals
from toongeo.io import landmark_array
from toongeo.model import MorphableModel
from toongeo.pipeline.align.carry_inner_parts import carry_inner_parts
from toongeo.pipeline.align.rim_anchors import rim_anchors
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.protocols import Camera

RIM_WEIGHT = 0.01  # of the landmarks' weight: what lies between them is interpolated, not seen


@dataclass(frozen=True, eq=False)
class AlignedFace:
    """A face whose landmark vertices project onto the landmarks of the picture.

    Attributes
    ----------
    vertices : (n, 3) float64, mm, model frame
    camera : Camera
        The camera of the coarse fit.
    landmark_vertices : (68,) int64
        Vertices that served as anchors.
    model : MorphableModel
    fit : FaceFit
        The coarse fit from which the face was deformed.
    report : dict
        ``rms_px`` and ``max_px`` of the anchors, ``seconds``.
    """

    vertices: np.ndarray
    camera: Camera
    landmark_vertices: np.ndarray
    model: MorphableModel
    fit: FaceFit
    report: dict[str, float]

    def __post_init__(self) -> None:
        read_only(self, "vertices", "landmark_vertices")

    @property
    def faces(self) -> np.ndarray:
        """Triangles (m, 3), counter-clockwise from outside."""
        return self.model.faces

    @cached_property
    def normals(self) -> np.ndarray:
        """Unit vertex normals (n, 3), model frame."""
        return vertex_normals(self.vertices, self.faces)

    def project(self, points: np.ndarray) -> np.ndarray:
        """Pixels (k, 2) of model-frame points (k, 3), in mm."""
        return self.camera.project(points)

    def region(self, name: str) -> np.ndarray:
        """Mask (n,) of a named region of the model."""
        return self.model.region(name)


def align_face(
    fit: FaceFit,
    landmarks: np.ndarray,
    *,
    weight: float = 1e4,
    laplacian: Literal["uniform", "cotangent"] = "uniform",
) -> AlignedFace:
    """Deform a fitted face so that its landmark vertices project onto the landmarks (Pan et al. 2024, section 3.2.2).

    The anchors of :func:`laplacian_align` are the landmark vertices of the fit. Where a landmark asks for its vertex is
    found in the picture; how far the vertex is from the camera is kept (Eq. 11). The rims of eyes and lips are anchored
    between the landmarks too, more softly, with interpolated displacements. What lies behind an opening (sockets,
    mouth cavity, teeth, tongue) is carried along with its rim.

    Parameters
    ----------
    fit : FaceFit
    landmarks : (68, 2) float, px
        NaN rows are missing and anchor nothing.
    weight : float
        Lambda of Eq. 10. The default holds the anchors to about a hundredth of a pixel.
    laplacian : {"uniform", "cotangent"}

    Returns
    -------
    AlignedFace

    Raises
    ------
    ValueError
        If landmarks have another shape, hold infinities or are all missing, the weight is negative or not finite, or
        the Laplacian is unknown.
    """
    started = time.perf_counter()
    landmarks = landmark_array(landmarks)
    seen = np.isfinite(landmarks).all(1)
    V = fit.vertices
    anchors, targets_px = _merged(fit.landmark_vertices[seen], landmarks[seen])
    rim, rim_shift_px = rim_anchors(fit.model, landmarks - fit.project(V[fit.landmark_vertices]))
    weights = np.r_[np.full(len(anchors), weight), np.full(len(rim), RIM_WEIGHT * weight)]
    anchors = np.r_[anchors, rim]
    targets_px = np.vstack([targets_px, fit.project(V[rim]) + rim_shift_px])
    targets = fit.camera.unproject(targets_px, fit.camera.depth(V[anchors]))  # Eq. 11
    aligned = laplacian_align(V, fit.faces, anchors, targets, weight=weights, laplacian=laplacian)  # Eq. 10
    aligned = carry_inner_parts(fit.model, V, aligned)
    error = np.linalg.norm(fit.camera.project(aligned[fit.landmark_vertices[seen]]) - landmarks[seen], axis=1)
    return AlignedFace(
        vertices=aligned,
        camera=fit.camera,
        landmark_vertices=fit.landmark_vertices,
        model=fit.model,
        fit=fit,
        report={
            "rms_px": float(np.sqrt((error**2).mean())),
            "max_px": float(error.max()),
            "seconds": time.perf_counter() - started,
        },
    )


def _merged(anchors: np.ndarray, targets_px: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Anchors without repetition: at an extreme pose two jaw points can share a vertex, which then takes their mean."""
    unique, inverse, count = np.unique(anchors, return_inverse=True, return_counts=True)
    mean = np.zeros((len(unique), 2))
    np.add.at(mean, inverse, targets_px)
    return unique, mean / count[:, None]
