"""The named expressions of the template, transferred to a new face."""

import time

import numpy as np

from toongeo.geometry import DeformationTransfer
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.gaze import GAZE_NAMES
from toongeo.pipeline.rig.rig import Rig

MOVES_MM = 0.05  # what moves less than this in every expression is held still


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
        With the ``model.n_named`` named expressions of the model; nothing follows the gaze yet.
    """
    started = time.perf_counter()
    model = face.model
    shapes = model.expression[: model.n_named]
    transfer = DeformationTransfer(model.mean, model.faces, face.vertices, pinned=_still_vertices(model), align=True)
    deltas = np.empty(shapes.shape, np.float32)
    for k, shape in enumerate(shapes):
        deltas[k] = transfer.transfer(model.mean + shape) - face.vertices
    return Rig(
        names=model.expression_names[: model.n_named],
        neutral=face.vertices,
        deltas=deltas,
        gaze=np.zeros((len(GAZE_NAMES), *face.vertices.shape), np.float32),
        pose=np.zeros(model.n_named),
        report={"seconds": time.perf_counter() - started},
    )


def _still_vertices(model: MorphableModel) -> np.ndarray:
    motion = np.abs(model.expression[: model.n_named]).max(axis=(0, 2))
    return np.flatnonzero(motion < MOVES_MM)
