"""The coarse face deformed onto the landmarks of the picture.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/alignment.py``).
"""

import time
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo._read_only import read_only, restored
from toongeo.geometry import laplacian_align, vertex_normals
from toongeo.model import MorphableModel
from toongeo.model.anatomy.rim_anchors import rim_anchors
from toongeo.model.anatomy.straighten_teeth import straighten_teeth
from toongeo.model.anatomy.visible_contour import visible_contour
from toongeo.pipeline.align.bounded_nose import bounded_nose
from toongeo.pipeline.align.carry_inner_parts import carry_inner_parts
from toongeo.pipeline.align.denoise_landmarks import LandmarkNoise, Noise, denoise_landmarks
from toongeo.pipeline.align.keep_ears_rigid import keep_ears_rigid
from toongeo.pipeline.align.keep_rims_apart import keep_rims_apart
from toongeo.pipeline.align.keep_teeth_inside import keep_teeth_inside
from toongeo.pipeline.align.noise.curve_points import with_curve_points
from toongeo.pipeline.align.symmetric_flow import symmetric_flow
from toongeo.pipeline.align.unfolded_start import unfolded_start
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.protocols import HeadCamera

__all__ = ["AlignReport", "AlignedFace", "align_face"]

_Laplacian = Literal["uniform", "cotangent"]
_RIM_WEIGHT = 0.01  # of the landmarks' weight: what lies between them is interpolated, not seen


@dataclass(frozen=True)
class AlignReport:
    """How an alignment went.

    Attributes
    ----------
    rms_px, max_px : float
        Distances of the anchors from their landmarks as they were given.
    seconds : float
    noise : LandmarkNoise, optional
        Of the landmarks; None where they were met as they are.
    """

    rms_px: float = 0.0
    max_px: float = 0.0
    seconds: float = 0.0
    noise: LandmarkNoise | None = None


@dataclass(frozen=True, eq=False)
class AlignedFace:
    """A face whose landmark vertices project onto the landmarks of the picture.

    Attributes
    ----------
    vertices : (n, 3) float64, mm, model frame
    camera : HeadCamera
        The camera of the coarse fit.
    landmark_vertices : (68,) int64
        Vertices that served as anchors.
    model : MorphableModel
    fit : FaceFit
        The coarse fit from which the face was deformed; with less of its expression where that folds the skin.
    report : AlignReport

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> face.vertices.shape, face.faces.shape  # mm; triangles
    ((19057, 3), (37568, 3))
    >>> reached = face.project(face.vertices[face.landmark_vertices])  # px
    >>> bool(abs(reached - landmarks).max() < 0.1)  # px
    True
    >>> int(face.region("lips").sum()) > 0
    True
    """

    vertices: np.ndarray
    camera: HeadCamera
    landmark_vertices: np.ndarray
    model: MorphableModel
    fit: FaceFit
    report: AlignReport

    __repr__ = brief_repr
    _repr_png_ = notebook_png
    __setstate__ = restored

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
    laplacian: _Laplacian = "uniform",
    depth: Literal["keep", "scaled"] = "scaled",
    slide: bool = True,
    flow: bool = True,
    noise: Noise = "auto",
    scheme: str = "ibug68",
) -> AlignedFace:
    """Deform a fitted face so that its landmark vertices project onto the landmarks (Pan et al. 2024, section 3.2.2).

    First the face flows most of the way by the smooth motion that is most likely when left and right move alike
    (:func:`~toongeo.pipeline.align.symmetric_flow.symmetric_flow`), which cannot fold it. Then the landmark vertices
    become the anchors of :func:`laplacian_align`, which closes the rest of the way. The rims of eyes and lips are
    anchored between the landmarks too, more softly, with interpolated displacements; upper and lower rims keep their
    order. What lies behind an opening (sockets, mouth cavity) flows along; teeth, tongue and ears do not bend.

    Parameters
    ----------
    fit : FaceFit
    landmarks : (68, 2) float, px
        NaN rows are missing. One on the jaw, a brow or the nose whose neighbours are there is filled in from these.
    weight : float
        Lambda of Eq. 10. The default holds the anchors to about a hundredth of a pixel.
    laplacian : {"uniform", "cotangent"}
    depth : {"keep", "scaled"}
        ``"keep"`` is Eq. 11: how far a vertex is from the camera does not change, so that a nose drawn twice as
        big stays as flat as it was. With ``"scaled"`` the flow has depth too: what grows in the picture grows
        towards the viewer as well, and what a turned face shows of one half happens to the other; a nose comes
        forward no farther than noses do. Without the flow the two are the same.
    slide : bool
        Whether jaw points slide along their contour lines to where the outline of the deformed head is.
        ``landmark_vertices`` of the result tell where they ended.
    flow : bool
        False: Laplacian deformation alone, as in the paper, which folds lids and lips of strong exaggerations.
    noise : "auto" or float
        Standard deviation of the landmarks' noise, in outer-eye distances. Noisy points are smoothed, and points that
        the others contradict are put back, before the face is moved to them; ``"auto"`` does so only where it is plain
        from the points, and 0 never (:func:`~toongeo.pipeline.align.denoise_landmarks.denoise_landmarks`).
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    AlignedFace

    Raises
    ------
    ValueError
        If landmarks have another shape, hold infinities or are all missing, the weight is negative or not finite, or
        the Laplacian, the depth rule or the noise is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> fit = tg.fit_3dmm(None, landmarks)
    >>> face = tg.align_face(fit, landmarks)
    >>> reached = face.project(face.vertices[face.landmark_vertices])  # px
    >>> bool(abs(reached - landmarks).max() < 0.1)
    True
    >>> face.vertices.shape == fit.vertices.shape
    True
    """
    started = time.perf_counter()
    given = ibug_landmarks(landmarks, scheme)
    if depth not in ("keep", "scaled"):
        raise ValueError(f"depth: expected 'keep' or 'scaled', got {depth!r}")
    cleaned = denoise_landmarks(fit, given, noise)
    landmarks = cleaned.points
    if flow:
        fit = unfolded_start(fit)
    V, at = fit.vertices, fit.landmark_vertices
    if flow:
        V, at = symmetric_flow(fit.model, fit.camera, V, at, landmarks, depth, slide)
        landmarks = with_curve_points(landmarks, fit.camera.project(V[at]))
    elif slide:
        at = visible_contour(fit.model, fit.camera, _anchored(fit, V, at, landmarks, weight, laplacian), at)
    aligned = _anchored(fit, V, at, landmarks, weight, laplacian)
    if flow and depth == "scaled":
        aligned = bounded_nose(fit.model, fit.camera, aligned)
    inner = straighten_teeth if flow else carry_inner_parts
    aligned = keep_teeth_inside(fit.model, inner(fit.model, fit.vertices, aligned))
    if flow:
        aligned = keep_ears_rigid(fit.model, fit.vertices, aligned)
    seen = np.isfinite(given).all(1)
    error = np.linalg.norm(fit.camera.project(aligned[at[seen]]) - given[seen], axis=1)
    return AlignedFace(
        vertices=aligned,
        camera=fit.camera,
        landmark_vertices=at,
        model=fit.model,
        fit=fit,
        report=AlignReport(
            rms_px=float(np.sqrt((error**2).mean())),
            max_px=float(error.max()),
            seconds=time.perf_counter() - started,
            noise=cleaned.change,
        ),
    )


def _anchored(
    fit: FaceFit, V: np.ndarray, at: np.ndarray, landmarks: np.ndarray, weight: float, laplacian: _Laplacian
) -> np.ndarray:
    """Vertices with those at the landmarks on them, and the rims between them taken along."""
    seen = np.isfinite(landmarks).all(1)
    anchors, targets_px = _merged(at[seen], landmarks[seen])
    rim, rim_shift_px = rim_anchors(fit.model, landmarks - fit.project(V[at]))
    given = np.arange(len(anchors) + len(rim)) < len(anchors)
    anchors = np.r_[anchors, rim]
    targets_px = np.vstack([targets_px, fit.project(V[rim]) + rim_shift_px])
    targets_px, depth = keep_rims_apart(fit.model, fit.camera, V, anchors, targets_px, given)
    targets = fit.camera.unproject(targets_px, depth)  # Eq. 11
    weights = np.where(given, 1.0, _RIM_WEIGHT) * weight
    return laplacian_align(V, fit.faces, anchors, targets, weight=weights, laplacian=laplacian)  # Eq. 10


def _merged(anchors: np.ndarray, targets_px: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Anchors without repetition: at an extreme pose two jaw points can share a vertex, which then takes their mean."""
    unique, inverse, count = np.unique(anchors, return_inverse=True, return_counts=True)
    mean = np.zeros((len(unique), 2))
    np.add.at(mean, inverse, targets_px)
    return unique, mean / count[:, None]
