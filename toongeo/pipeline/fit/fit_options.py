"""What can be set in a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from toongeo.io import SCHEMES
from toongeo.pipeline.fit.adjust_coefficients import ADJUSTMENTS
from toongeo.pipeline.fit.check_positive import check_positive
from toongeo.pipeline.fit.fit_option_groups import JawOptions, PriorOptions, SolverOptions
from toongeo.pipeline.fit.landmarks.robust_weights import KERNELS
from toongeo.pipeline.fit.problem.told_convention import CONVENTIONS

__all__ = ["FitOptions", "changed_options"]


_CONTOURS = ("lines", "silhouette")
_CAMERAS = ("orthographic", "perspective")


@dataclass(frozen=True)
class FitOptions:
    """Weights and limits of `fit_3dmm`; the defaults were found on 3D ground truth.

    Attributes
    ----------
    landmark_weight, prior_weight : float
        ``w_l`` and ``w_r`` of Eq. 3 (Pan et al. 2024). Landmark errors are measured in outer-eye distances.
    prior : PriorOptions
        What is likely: weights and deviations of identity, expression, pitch and landmarks.
    jaw : JawOptions
        How much the points of the jaw count.
    contour : {"lines", "silhouette"}
        Where a jaw point lies: on its contour line, where that turns out of sight, or where the silhouette is nearest.
    robust : {"geman-mcclure", "huber"} or None
        Kernel of the landmark errors, as wide as their median asks: between the passes a point that lies far
        off beside the others loses weight. None is least squares.
    camera : {"orthographic", "perspective"}
    focal_px : float or None
        Focal length of the perspective camera in pixels; None: it is estimated, with the head between 0.35 and
        5 m away. Landmarks tell it badly, so give it where it is known.
    principal_point : (x, y) px or None
        Of the perspective camera; None: the middle of the picture, or of the face when there is no picture.
    scheme : str, (k,) int array, or a pair (faces (k,), weights (k, 3))
        What the landmarks are: a known scheme, vertices of the model, or points in its triangles. With a table
        all points count alike, none slides along the jaw, and the 68 vertices of the result are the model's own.
    convention : {"auto", "annotators", "scans"}
        Whose definition of the 68 landmarks the points follow: that of people who annotate pictures, or that of the
        scans (ICT-FaceKit) whose statistics the model's prior holds, which have the bridge of the nose, the brows and
        the corners of the mouth elsewhere. ``"auto"`` takes the second only where it explains the points far better.
    adjust : {"expression", "identity+expression"} or None
        Bend the coefficients onto the landmarks in the end, without a prior: see `adjust_coefficients`.
    refine : bool
        Whether a regressor's coefficients are where the fit starts, or, if False, the answer; a pose that the
        regressor does not give is found for its shape.
    solver : SolverOptions
        When a minimisation ends.

    Raises
    ------
    ValueError
        If a weight is not positive and finite (without its prior the fit has no unique answer), a group is of another
        kind, or a name is not known.

    Examples
    --------
    >>> from toongeo.pipeline import SolverOptions
    >>> options = FitOptions(robust=None, camera="perspective", solver=SolverOptions(max_passes=1))
    >>> options.solver.max_passes, options.prior.max_deviation
    (1, 3.0)
    """

    landmark_weight: float = 1.0
    prior_weight: float = 4e-6
    prior: PriorOptions = field(default_factory=PriorOptions)
    jaw: JawOptions = field(default_factory=JawOptions)
    contour: str = "lines"
    robust: str | None = "geman-mcclure"
    camera: str = "orthographic"
    focal_px: float | None = None
    principal_point: tuple[float, float] | None = None
    scheme: Any = "ibug68"
    convention: str = "auto"
    adjust: str | None = None
    refine: bool = True
    solver: SolverOptions = field(default_factory=SolverOptions)

    def __post_init__(self) -> None:
        for name in ("landmark_weight", "prior_weight"):
            check_positive(name, getattr(self, name))
        for name, kind in (("prior", PriorOptions), ("jaw", JawOptions), ("solver", SolverOptions)):
            if not isinstance(getattr(self, name), kind):
                raise ValueError(f"{name}: expected {kind.__name__}, got {type(getattr(self, name)).__name__}")
        _known("robust", self.robust, (None, *KERNELS))
        _known("adjust", self.adjust, (None, *ADJUSTMENTS))
        _known("convention", self.convention, CONVENTIONS)
        _known("camera", self.camera, _CAMERAS)
        _known("contour", self.contour, _CONTOURS)
        self._check_lens()
        named = isinstance(self.scheme, str)
        if named:
            _known("scheme", self.scheme, tuple(SCHEMES))
        if self.adjust is not None and not named:
            raise ValueError("adjust: expected a scheme by name to go with it, got a table")
        if not isinstance(self.refine, bool):
            raise ValueError(f"refine: expected one of True, False, got {self.refine!r}")

    def _check_lens(self) -> None:
        for name in ("focal_px", "principal_point"):
            if getattr(self, name) is not None and self.camera != "perspective":
                raise ValueError(f"{name}: expected camera='perspective' to go with it, got {self.camera!r}")
        if self.focal_px is not None:
            check_positive("focal_px", self.focal_px)
        point = self.principal_point
        if point is not None and not (_are_two_numbers(point) and np.isfinite(point).all()):
            raise ValueError(f"principal_point: expected 2 finite numbers (x, y) in px or None, got {point!r}")


def _are_two_numbers(point: object) -> bool:
    array = np.asarray(point)
    return array.shape == (2,) and array.dtype.kind in "fiu"


def _known(name: str, value: object, known: tuple[object, ...]) -> None:
    if value not in known:
        raise ValueError(f"{name}: expected one of {', '.join(map(repr, known))}, got {value!r}")


_DEFAULT = FitOptions()


def changed_options(options: FitOptions | None, changes: Mapping[str, Any]) -> FitOptions:
    """``options``, or the defaults if None, with some fields changed; an unknown field lists the known ones."""
    known = [option.name for option in fields(FitOptions)]
    for name in changes:
        if name not in known:
            raise TypeError(f"{name}: no such option; known: {', '.join(known)}")
    options = _DEFAULT if options is None else options
    return replace(options, **changes) if changes else options
