"""The coarse face: what `fit_3dmm` returns."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo._read_only import read_only, restored
from toongeo.model.default_model import default_model
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.fit_dict import camera_dict, checked_model, plain, read_camera, read_report, report_dict
from toongeo.pipeline.fit.fit_file import read_fields, write_fields
from toongeo.pipeline.fit.model_checksum import model_checksum
from toongeo.protocols import HeadCamera

__all__ = ["FaceFit", "FitReport", "PhotometricReport"]


@dataclass(frozen=True)
class FitReport:
    """How a fit went.

    Attributes
    ----------
    algorithm, status : str
        nlopt's names; the status is that of the last pass.
    passes, evaluations : int
        Placements of the jaw points; calls of the loss in all passes.
    landmark_loss, prior_loss : float
        Eq. 4 (errors in outer-eye distances) and Eq. 6 of Pan et al. 2024, the latter with the prior on the pitch;
        unweighted.
    prior_weight : float
        ``w_r`` of Eq. 3 in the last pass: that of the options, or more where the face misses its landmarks by much.
    loss : float
        Their weighted sum, Eq. 3.
    rms_px : float
        Root mean square distance of the inner landmarks (17-67) that are there.
    rms_percent : float
        The same in percent of the distance of the outer eye corners (36, 45) in the picture, or in the
        fit when one of them is missing. Both are NaN when no inner landmark is there.
    warnings : tuple of str
        What seems odd about the landmarks, from `toongeo.io.check_landmarks`.
    seconds : float
    outliers : tuple of int
        Landmarks that the robust kernel has all but ignored (weight below 0.1).
    convention : {"annotators", "scans"}
        Whose definition of the landmarks the points were taken to follow.
    """

    algorithm: str
    status: str
    passes: int
    evaluations: int
    landmark_loss: float
    prior_loss: float
    prior_weight: float
    loss: float
    rms_px: float
    rms_percent: float
    warnings: tuple[str, ...]
    seconds: float
    outliers: tuple[int, ...] = ()
    convention: str = "annotators"


@dataclass(frozen=True)
class PhotometricReport:
    """How a photometric refinement went.

    Attributes
    ----------
    residual_ambient, residual_before, residual_after : float
        Root mean square difference of rendering and picture in sRGB, 0..1, over the channels and the visible samples
        weighted by the confidence map, the same for all three: the mean albedo on the face of the landmarks alone,
        in ambient light of the best colour, and in the best light; and what was found.
    confident_fraction : float
        Share of the visible face that the confidence map believes.
    status : str
        nlopt's, of the last pass.
    passes : int
    evaluations : int
        Of the quadratic models of the loss, in all passes.
    seconds : float
    """

    residual_ambient: float
    residual_before: float
    residual_after: float
    confident_fraction: float
    status: str
    passes: int
    evaluations: int
    seconds: float


@dataclass(frozen=True, eq=False)
class FaceFit:
    """A morphable model posed and shaped after a picture.

    Attributes
    ----------
    identity : (81,) float64
        Standard deviations.
    expression : (64,) float64
        Named expressions in [0, 1], the others in standard deviations.
    camera : HeadCamera
    landmark_vertices : (68,) int64
        Vertices of the landmarks as this pose shows them: jaw points lie on the outline of the head.
    model : MorphableModel
    report : FitReport
    albedo : (9,) float64 or None
        Standard deviations; None where only landmarks were fitted.
    light : (9, 3) float64 or None
        Radiance in spherical harmonics, camera frame, for `toongeo.render.irradiance`.
    photometric : PhotometricReport or None

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> fit = tg.fit_3dmm(None, landmarks)
    >>> fit.vertices.shape, fit.identity.shape, fit.expression.shape
    ((19057, 3), (81,), (64,))
    >>> fit.project(fit.vertices[fit.landmark_vertices]).shape  # px
    (68, 2)
    >>> fit.save("fit.npz")
    >>> bool((tg.FaceFit.load("fit.npz").vertices == fit.vertices).all())
    True
    """

    identity: NDArray[np.float64]
    expression: NDArray[np.float64]
    camera: HeadCamera
    landmark_vertices: NDArray[np.int64]
    model: MorphableModel
    report: FitReport
    albedo: NDArray[np.float64] | None = None
    light: NDArray[np.float64] | None = None
    photometric: PhotometricReport | None = None

    __repr__ = brief_repr
    _repr_png_ = notebook_png
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "identity", "expression", "landmark_vertices", "albedo", "light")

    @cached_property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices (n, 3), mm, model frame; read-only."""
        V = self.model.vertices(self.identity, self.expression)
        V.setflags(write=False)
        return V

    @property
    def faces(self) -> NDArray[np.int64]:
        """Triangles (m, 3) of the model."""
        return self.model.faces

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> pixels (k, 2)."""
        return self.camera.project(np.asarray(points, np.float64))

    def region(self, name: str) -> NDArray[np.bool_]:
        """Mask (n,) of a named region of the model, such as ``"face"`` or ``"lips"``."""
        return self.model.region(name)

    def to_dict(self) -> dict[str, Any]:
        """All of the fit but the model, of which it holds a checksum: numbers, texts, lists, mappings and None."""
        arrays = ("identity", "expression", "landmark_vertices", "albedo", "light")
        return {
            "model": model_checksum(self.model),
            **{name: plain(getattr(self, name)) for name in arrays},
            "camera": camera_dict(self.camera),
            "report": report_dict(self.report),
            "photometric": report_dict(self.photometric),
        }

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write ``.json`` or ``.npz``, for :meth:`load`: bit for bit, and nothing in it is ever executed.

        Raises
        ------
        ValueError
            If the suffix is neither, or the camera is none of the library's.
        OSError
            If the file cannot be written; nothing half-written is left.
        """
        write_fields(path, self.to_dict())

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, model: MorphableModel | None = None) -> FaceFit:
        """Read what :meth:`save` wrote.

        Parameters
        ----------
        path
            ``.json`` or ``.npz``.
        model : MorphableModel, optional
            The model of the fit, if it is not :func:`toongeo.default_model`.

        Raises
        ------
        ValueError
            If the file is no fit, or one of another model.
        OSError
            If it cannot be read.
        """
        content = read_fields(path)
        try:
            return cls(
                identity=np.array(content["identity"], np.float64),
                expression=np.array(content["expression"], np.float64),
                camera=read_camera(content["camera"]),
                landmark_vertices=np.array(content["landmark_vertices"], np.int64),
                model=checked_model(content, default_model() if model is None else model),
                report=read_report(FitReport, content["report"]),
                albedo=_array(content["albedo"]),
                light=_array(content["light"]),
                photometric=read_report(PhotometricReport, content["photometric"]),
            )
        except (LookupError, TypeError, AttributeError) as error:
            raise ValueError(f"path: expected a fit that was saved, got {path} ({error})") from error

    def expression_weights(self) -> dict[str, float]:
        """The named expressions with their weights in [0, 1]."""
        named = self.model.expression_names[: self.model.n_named]
        return {name: float(weight) for name, weight in zip(named, self.expression, strict=False)}


def _array(values: list[Any] | None) -> NDArray[np.float64] | None:
    return None if values is None else np.array(values, np.float64)
