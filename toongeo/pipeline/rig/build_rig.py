"""The named expressions of the template, transferred to a new face."""

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only
from toongeo.geometry import DeformationTransfer
from toongeo.geometry.one_thread import one_thread
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.weight_vector import weight_vector

MOVES_MM = 0.05  # what moves less than this in every expression is held still


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
    report : dict
        ``seconds``.
    """

    names: tuple[str, ...]
    neutral: np.ndarray
    deltas: np.ndarray
    report: dict[str, float]

    def __post_init__(self) -> None:
        read_only(self, "neutral", "deltas")

    def vertices(self, weights: Mapping[str, float] | np.ndarray | None = None) -> np.ndarray:
        """Vertices (n, 3), mm, for weights by name or a vector (k,); None is the neutral face.

        Raises
        ------
        ValueError
            If a name is unknown, a vector has another length, or a weight is not finite.
        """
        beta = weight_vector(weights, self.names)
        active = np.flatnonzero(beta)
        with one_thread():
            moved = np.tensordot(beta[active].astype(np.float32), self.deltas[active], 1)
        return self.neutral + moved


def build_rig(face: AlignedFace) -> Rig:
    """Expressions of the template's mean face, transferred to this face (Pan et al. 2024, section 3.3).

    The face as it was aligned is taken for neutral. The gradients of each template expression are carried over by
    :class:`toongeo.DeformationTransfer`; vertices that no expression moves on the template (skull, neck, ears) are
    pinned.

    Parameters
    ----------
    face : AlignedFace

    Returns
    -------
    Rig
        With the ``model.n_named`` named expressions of the model.
    """
    started = time.perf_counter()
    model = face.model
    shapes = model.expression[: model.n_named]
    transfer = DeformationTransfer(model.mean, model.faces, face.vertices, pinned=_still_vertices(model))
    deltas = np.empty(shapes.shape, np.float32)
    for k, shape in enumerate(shapes):
        deltas[k] = transfer.transfer(model.mean + shape) - face.vertices
    return Rig(
        names=model.expression_names[: model.n_named],
        neutral=face.vertices,
        deltas=deltas,
        report={"seconds": time.perf_counter() - started},
    )


def _still_vertices(model: MorphableModel) -> np.ndarray:
    motion = np.abs(model.expression[: model.n_named]).max(axis=(0, 2))
    return np.flatnonzero(motion < MOVES_MM)
