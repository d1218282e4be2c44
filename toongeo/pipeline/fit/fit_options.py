"""What can be set in a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from toongeo.pipeline.fit.adjust_coefficients import ADJUSTMENTS
from toongeo.pipeline.fit.check_positive import check_positive
from toongeo.pipeline.fit.landmarks.ibug_landmarks import SCHEMES
from toongeo.pipeline.fit.landmarks.robust_weights import KERNELS

__all__ = ["FitOptions", "changed_options"]


_MAY_BE_ZERO = ("jaw_weight", "jaw_tangent")
_CONTOURS = ("lines", "silhouette")
_CAMERAS = ("orthographic", "perspective")
_COUNTS = ("max_passes", "max_evaluations")
_NUMBERS = (
    "landmark_weight", "prior_weight", "landmark_deviation", "pitch_deviation", "identity_weight",
    "expression_weight", "jaw_weight", "jaw_tangent", "max_deviation", "tolerance",
)  # fmt: skip


@dataclass(frozen=True)
class FitOptions:
    """Weights and limits of `fit_3dmm`; the defaults were found on 3D ground truth.

    Attributes
    ----------
    landmark_weight, prior_weight : float
        ``w_l`` and ``w_r`` of Eq. 3 (Pan et al. 2024). Landmark errors are measured in outer-eye distances.
    landmark_deviation : float
        Standard deviation of the misfit of a coordinate that is expected of people, in outer-eye distances. Where a
        face (a caricature, say) misses its landmarks by more, ``w_r`` grows with the square of the misfit.
    pitch_deviation : float, degrees
        Standard deviation of the pitch of heads in pictures.
    identity_weight, expression_weight : float
        ``w_id`` and ``w_exp`` of Eq. 6.
    jaw_weight : float
        ``w_n`` of Eq. 4 for the 17 jaw points; the inner points have 1 (on average, where the model knows the noise of
        each). Where an annotator puts a jaw point is a matter of taste, and with full weight they made the face worse
        in 3D than the mean face is.
    jaw_tangent : float in [0, 1]
        How much an error along the jaw's outline counts against one across it.
    contour : {"lines", "silhouette"}
        Where a jaw point lies: on its contour line, where that turns out of sight, or where the silhouette is nearest.
    max_deviation : float
        Bound of identity and unnamed expression coefficients, in standard deviations from the likeliest ones.
    max_passes : int
        How often at most the jaw points are placed anew on their lines.
    tolerance : float
        Relative change of the loss at which a pass stops.
    max_evaluations : int
        Of the loss, in one pass.
    max_seconds : float or None
        Of one pass; None: no limit. With a limit two runs may end at different faces.
    robust : {"geman-mcclure", "huber"} or None
        Kernel of the landmark errors, as wide as their median asks: between the passes a point that lies far
        off beside the others loses weight. None is least squares.
    camera : {"orthographic", "perspective"}
    focal_px : float or None
        Focal length of the perspective camera in pixels; None: it is estimated, with the head between 0.35 and
        5 m away. Landmarks tell it badly, so give it where it is known.
    principal_point : (x, y) px or None
        Of the perspective camera; None: the middle of the picture, or of the face when there is no picture.
    scheme : {"ibug68", "ibug51", "ibug49", "mediapipe478"}, (k,) int array, or a pair (faces (k,), weights (k, 3))
        What the landmarks are: a known scheme, vertices of the model, or points in its triangles. With a table
        all points count alike, none slides along the jaw, and the 68 vertices of the result are the model's own.
    adjust : {"expression", "identity+expression"} or None
        Bend the coefficients onto the landmarks in the end, without a prior: see `adjust_coefficients`.
    refine : bool
        Whether a regressor's coefficients are where the fit starts, or, if False, the answer; a pose that the
        regressor does not give is found for its shape.

    Raises
    ------
    ValueError
        If a jaw weight is negative, another weight or a limit not positive, or one of them not finite. Without its
        prior the fit has no unique answer. If a name is not known.
    """

    landmark_weight: float = 1.0
    prior_weight: float = 4e-6
    landmark_deviation: float = 0.014
    pitch_deviation: float = 6.0
    identity_weight: float = 1.0
    expression_weight: float = 4.0
    jaw_weight: float = 0.015
    jaw_tangent: float = 0.35
    contour: str = "lines"
    max_deviation: float = 3.0
    max_passes: int = 4
    tolerance: float = 1e-6
    max_evaluations: int = 2000
    max_seconds: float | None = None
    robust: str | None = "geman-mcclure"
    camera: str = "orthographic"
    focal_px: float | None = None
    principal_point: tuple[float, float] | None = None
    scheme: Any = "ibug68"
    adjust: str | None = None
    refine: bool = True

    def __post_init__(self) -> None:
        for name in _NUMBERS:
            check_positive(name, getattr(self, name), zero=name in _MAY_BE_ZERO)
        for name in _COUNTS:
            check_positive(name, getattr(self, name), whole=True)
        if self.max_seconds is not None:
            check_positive("max_seconds", self.max_seconds)
        _known("robust", self.robust, (None, *KERNELS))
        _known("adjust", self.adjust, (None, *ADJUSTMENTS))
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
        if self.jaw_tangent > 1:
            raise ValueError(f"jaw_tangent: expected a number in [0, 1], got {self.jaw_tangent!r}")

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


def changed_options(options: FitOptions | None, changes: Mapping[str, Any]) -> FitOptions:
    """``options``, or the defaults if None, with some fields changed; an unknown field lists the known ones."""
    known = [field.name for field in fields(FitOptions)]
    for name in changes:
        if name not in known:
            raise TypeError(f"{name}: no such option; known: {', '.join(known)}")
    return replace(FitOptions() if options is None else options, **changes)
