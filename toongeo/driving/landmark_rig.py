"""What a performer's landmarks can do: 68 points and how each expression moves them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.model.expression_schemes import EXPRESSIONS
from toongeo.pipeline import AlignedFace, Rig, align_face, build_rig, fit_3dmm, fit_3dmm_together, fit_lids

__all__ = ["LandmarkRig", "PerformerFace"]

_SEVERAL = 6  # frames that a performer's face is found from when none is known to be neutral


@dataclass(frozen=True, eq=False)
class LandmarkRig:
    """The landmarks of a rigged face.

    Attributes
    ----------
    names : tuple of k expressions
    neutral : (68, 3) float64, mm, model frame
    deltas : (k, 68, 3) float64, mm
        What each expression at weight 1 adds.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.driving import LandmarkRig
    >>> model = tg.default_model()
    >>> deltas = model.expression[: model.n_named, model.landmarks].astype(float)
    >>> rig = LandmarkRig(model.expression_names[: model.n_named], model.mean[model.landmarks], deltas)
    >>> 100 < rig.width < 200  # mm, from ear to ear
    True
    """

    names: tuple[str, ...]
    neutral: Floats
    deltas: Floats

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        shapes = np.shape(self.neutral), np.shape(self.deltas)
        if shapes != ((68, 3), (len(self.names), 68, 3)):
            raise ValueError(f"neutral, deltas: expected (68, 3) and ({len(self.names)}, 68, 3), got {shapes}")
        read_only(self, "neutral", "deltas")

    @property
    def width(self) -> float:
        """Of the face from ear to ear, mm: the unit in which errors of landmarks are told."""
        return float(np.ptp(self.neutral[:, 0]))

    def all_weights(self, weights: Floats) -> Floats:
        """Weights (f, k) of its expressions as (f, 54) of ``EXPRESSIONS``, 0 for those that it has not."""
        rows = np.zeros((len(weights), len(EXPRESSIONS)))
        rows[:, [EXPRESSIONS.index(name) for name in self.names]] = weights
        return rows

    @classmethod
    def of_rig(cls, rig: Rig, vertices: NDArray[np.integer]) -> LandmarkRig:
        """Of a rigged face whose landmarks lie at vertices (68,)."""
        return cls(rig.names, rig.neutral[vertices], rig.deltas[:, vertices].astype(np.float64))

    @classmethod
    def of_neutral(cls, landmarks: ArrayLike) -> LandmarkRig:
        """Of a performer of whom a frame (68, 2) px without expression is known.

        The frame is fitted and aligned as a picture would be, and the expressions of the template are transferred.
        """
        return PerformerFace.of_neutral(landmarks).landmarks

    @classmethod
    def of_frames(cls, frames: ArrayLike) -> LandmarkRig:
        """Of a performer who is only known from a sequence (f, 68, 2) px, NaN where missing.

        A few frames are fitted together: one identity, and an expression and a pose in each.
        """
        sequence = np.asarray(frames, np.float64)
        there = np.isfinite(sequence).all(axis=2).sum(axis=1)
        whole = np.flatnonzero(there == there.max())
        chosen = whole[np.unique(np.linspace(0, len(whole) - 1, _SEVERAL).round().astype(int))]
        fit = fit_3dmm_together([None] * len(chosen), list(sequence[chosen]))[0]
        model, n = fit.model, fit.model.n_named
        vertices = fit.landmark_vertices
        return cls(
            model.expression_names[:n],
            model.vertices(fit.identity)[vertices],
            model.expression[:n, vertices].astype(np.float64),
        )


@dataclass(frozen=True, eq=False)
class PerformerFace:
    """The whole face of a performer.

    Attributes
    ----------
    aligned : AlignedFace
    rig : Rig
        Its ``neutral`` is the face at rest.
    landmarks : LandmarkRig
        Of the same.
    """

    aligned: AlignedFace
    rig: Rig
    landmarks: LandmarkRig

    @classmethod
    def of_neutral(cls, landmarks: ArrayLike) -> PerformerFace:
        """As :meth:`LandmarkRig.of_neutral`."""
        face = align_face(fit_3dmm(None, landmarks), np.asarray(landmarks, np.float64))
        rig = fit_lids(face, build_rig(face))[0]
        return cls(face, rig, LandmarkRig.of_rig(rig, face.landmark_vertices))
