"""Blendshapes of one face."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo._read_only import read_only, restored
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.expression_schemes import SCHEMES
from toongeo.model.expression_weights import expression_weights
from toongeo.pipeline.rig.add_rows import add_rows
from toongeo.pipeline.rig.weight_vector import weight_vector

__all__ = ["Rig", "RigReport"]


@dataclass(frozen=True)
class RigReport:
    """How a rig came out; what no stage has told is None.

    Attributes
    ----------
    seconds : float
        Of all stages that worked on it.
    lips_closure : float
        Percent: how much less the lips are apart where ``mouthClose`` seals an open jaw.
    closure_left, closure_right : float
        Percent of each eye that its blink closes.
    matched, partnered, distance : float
        Of a head that was modelled elsewhere: shares of the template's face and of its own vertices that found a
        partner on the other, and the mean distance of those, in the head's unit.
    mouth_opens : bool
        Of such a head: False if its lips are one surface, which can only be stretched.
    """

    seconds: float = 0.0
    lips_closure: float | None = None
    closure_left: float | None = None
    closure_right: float | None = None
    matched: float | None = None
    partnered: float | None = None
    distance: float | None = None
    mouth_opens: bool | None = None


@dataclass(frozen=True, eq=False)
class Rig:
    """Blendshapes of one face: ``S* = S_0 + B beta`` (Pan et al. 2024, Eq. 13).

    Attributes
    ----------
    names : tuple of k names
    neutral : (n, 3) float64, mm, model frame
        S_0.
    deltas : (k, n, 3) float32, mm
        The rows of B: each expression at weight 1 minus the neutral face.
    gaze : (8, n, 3) float32, mm
        How the skin follows the eyes, for each of ``GAZE_NAMES``.
    pose : (k,) float64
        Weights of the expression that the picture shows.
    report : RigReport

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig = tg.build_rig(face)
    >>> len(rig.names), rig.deltas.shape
    (46, (46, 19057, 3))
    >>> bool((rig.vertices() == rig.neutral).all())
    True
    >>> moved = rig.vertices({"jawOpen": 0.5}) - rig.neutral  # (n, 3) mm
    >>> float(rig.weights({"jawOpen": 0.5}).sum())
    0.5
    """

    names: tuple[str, ...]
    neutral: np.ndarray
    deltas: np.ndarray
    gaze: np.ndarray
    pose: np.ndarray
    report: RigReport

    __repr__ = brief_repr
    _repr_png_ = notebook_png
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "neutral", "deltas", "gaze", "pose")

    def changed(self, started: float, **fields: Any) -> "Rig":
        """The same rig with other fields; its report counts the seconds since ``started`` (a `perf_counter`)."""
        report = replace(self.report, seconds=self.report.seconds + time.perf_counter() - started)
        return replace(self, report=report, **fields)

    def weights(self, weights: Mapping[str, float] | np.ndarray | None = None) -> np.ndarray:
        """Checked weights (k + 8,): of the expressions, then of ``GAZE_NAMES``.

        Parameters
        ----------
        weights : mapping of name to weight, (k,) array of the expressions, (k + 8,) array, or None for the neutral face
            Weights are not clipped: 1 is the full expression, more exaggerates it. ARKit's ``browInnerUp`` and
            ``cheekPuff`` stand for both their halves, so that ARKit's 52 names can be given as they are; for names of
            other systems see :func:`toongeo.expression_weights`.

        Raises
        ------
        ValueError
            If a name is unknown (the nearest are suggested), an array has another length, or a weight is not finite.
        """
        names = (*self.names, *GAZE_NAMES)
        if isinstance(weights, Mapping):
            weights = _by_our_names(weights, names)
        if weights is None or isinstance(weights, Mapping) or np.shape(weights) == (len(names),):
            return weight_vector(weights, names)
        return np.r_[weight_vector(weights, self.names), np.zeros(len(GAZE_NAMES))]

    def vertices(self, weights: Mapping[str, float] | np.ndarray | None = None) -> np.ndarray:
        """Vertices (n, 3), mm; weights and errors as for :meth:`weights`."""
        beta = self.weights(weights)
        k = len(self.names)
        moved = np.zeros(self.neutral.size, np.float32)
        add_rows(moved, self.deltas.reshape(k, moved.size), beta[:k])
        add_rows(moved, self.gaze.reshape(len(GAZE_NAMES), -1), beta[k:])
        return self.neutral + moved.reshape(self.neutral.shape)


def _by_our_names(weights: Mapping[str, float], names: tuple[str, ...]) -> Mapping[str, float]:
    """Weights without ARKit's names of two halves at once."""
    joint = [name for name in weights if name not in names and name in SCHEMES["arkit"]]
    if not joint:
        return weights
    split = {name: weight for name, weight in weights.items() if name not in joint}
    for name, weight in expression_weights({name: weights[name] for name in joint}).items():
        split[name] = split.get(name, 0.0) + weight
    return split
