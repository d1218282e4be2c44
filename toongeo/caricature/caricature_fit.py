"""A caricature in 3D: what `fit_caricature` returns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.caricature.space.face_space import FaceSpace
from toongeo.geometry import vertex_normals
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.protocols import HeadCamera

__all__ = ["CaricatureFit", "CaricatureReport"]


@dataclass(frozen=True)
class CaricatureReport:
    """How a caricature fit went.

    Attributes
    ----------
    iterations : int
        P'-steps up to the result.
    converged : bool
        Whether E_def fell by less than the tolerance after it, or in it.
    rms_px : float
        ``sqrt(E_lan / k)`` over the k landmarks that are there (Eq. 20).
    max_px : float
    warnings : tuple of str
        What seems odd about the landmarks, from `toongeo.io.check_landmarks`.
    seconds : float
    """

    iterations: int
    converged: bool
    rms_px: float
    max_px: float
    warnings: tuple[str, ...]
    seconds: float


@dataclass(frozen=True, eq=False)
class CaricatureFit:
    """A face of a deformation space, bent onto the landmarks of a picture.

    Attributes
    ----------
    vertices : (n, 3) float64, mm, model frame
        What the space does not deform (mouth, teeth, tongue) is carried along.
    w : (2, l) float64
        Weights of rotation and of scale/shear.
    energy : tuple of float
        E_def (Eq. 6) after each P'-step, mm^2.
    camera : HeadCamera
        Scaled orthographic, but for an exaggerated face that had another.
    landmark_vertices : (68,) int64
        Vertices of the landmarks as this pose shows them.
    space : FaceSpace
    fit : FaceFit
        The ordinary face from which it was deformed.
    report : CaricatureReport

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> fit = tg.fit_3dmm(None, landmarks)
    >>> twice = tg.exaggerate(fit, 1.0)  # as tg.fit_caricature(None, landmarks), but without a picture
    >>> twice.vertices.shape, twice.w.shape
    ((19057, 3), (2, 98))
    >>> bool(abs(twice.vertices - fit.vertices).max() > 1)  # mm
    True
    """

    vertices: Floats
    w: Floats
    energy: tuple[float, ...]
    camera: HeadCamera
    landmark_vertices: NDArray[np.int64]
    space: FaceSpace
    fit: FaceFit
    report: CaricatureReport

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "vertices", "w", "landmark_vertices")

    @property
    def model(self) -> MorphableModel:
        """The face model of the space."""
        return self.space.model

    @property
    def faces(self) -> NDArray[np.int64]:
        """Triangles (m, 3) of the model."""
        return self.model.faces

    @cached_property
    def normals(self) -> Floats:
        """Unit vertex normals (n, 3), model frame."""
        return vertex_normals(self.vertices, self.faces)

    def project(self, points: ArrayLike) -> Floats:
        """Points (k, 3), mm, model frame -> pixels (k, 2)."""
        return self.camera.project(np.asarray(points, np.float64))

    def region(self, name: str) -> NDArray[np.bool_]:
        """Mask (n,) of a named region of the model, such as ``"face"`` or ``"lips"``."""
        return self.model.region(name)
