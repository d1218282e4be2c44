"""Blendshapes of one face."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only
from toongeo.geometry.one_thread import one_thread
from toongeo.pipeline.rig.gaze import GAZE_NAMES
from toongeo.pipeline.rig.weight_vector import weight_vector


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
    report : dict
        ``seconds``.
    """

    names: tuple[str, ...]
    neutral: np.ndarray
    deltas: np.ndarray
    gaze: np.ndarray
    pose: np.ndarray
    report: dict[str, float]

    def __post_init__(self) -> None:
        read_only(self, "neutral", "deltas", "gaze", "pose")

    def weights(self, weights: Mapping[str, float] | np.ndarray | None = None) -> np.ndarray:
        """Checked weights (k + 8,): of the expressions, then of ``GAZE_NAMES``.

        Parameters
        ----------
        weights : mapping of name to weight, (k,) array of the expressions, (k + 8,) array, or None for the neutral face

        Raises
        ------
        ValueError
            If a name is unknown (the nearest are suggested), an array has another length, or a weight is not finite.
        """
        names = (*self.names, *GAZE_NAMES)
        if weights is None or isinstance(weights, Mapping) or np.shape(weights) == (len(names),):
            return weight_vector(weights, names)
        return np.r_[weight_vector(weights, self.names), np.zeros(len(GAZE_NAMES))]

    def vertices(self, weights: Mapping[str, float] | np.ndarray | None = None) -> np.ndarray:
        """Vertices (n, 3), mm; weights and errors as for :meth:`weights`."""
        beta = self.weights(weights).astype(np.float32)
        k = len(self.names)
        moved = np.zeros(self.neutral.shape, np.float32)
        with one_thread():
            for part, shapes in ((beta[:k], self.deltas), (beta[k:], self.gaze)):
                active = np.flatnonzero(part)
                moved += np.tensordot(part[active], shapes[active], 1)
        return self.neutral + moved
