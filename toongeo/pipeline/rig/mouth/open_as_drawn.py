"""A rig that can show the mouth of its picture.

Constants: see ``benchmarks/mouths.py``.
"""

import dataclasses
import time

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.lips_apart import lips_apart
from toongeo.model.anatomy.motion_shares import motion_shares
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.fit_pose import fit_pose
from toongeo.pipeline.rig.rig import Rig

__all__ = ["OPENING", "open_as_drawn"]

OPENING = ("jawOpen", "mouthLowerDownLeft", "mouthLowerDownRight", "mouthUpperUpLeft", "mouthUpperUpRight")
# Of a smile that is drawn, and stays in the face at rest, less is left to do.
_SMILING = ("mouthSmile", "mouthDimple", "mouthStretch", "mouthPress")
_LEFT = 0.35  # of these expressions at least
_FLOOR = 0.35  # weight that the opening expressions have at least in the pose of a mouth that is drawn well open
_OPEN = 0.33  # of the gap of `jawOpen`: with a mouth as open as this, or more, they have it
_ABLE = 0.1  # sum of squared weights below which less is asked: at 1, an expression shows up to thrice of it


def open_as_drawn(face: AlignedFace, rig: Rig, drawn: np.ndarray) -> Rig:
    """Give the expressions that open a mouth what they lack to show it as it is drawn.

    A mouth that was closed as curves does not open by itself the way it was drawn. These expressions are `jawOpen`,
    `mouthLowerDown*` and `mouthUpperUp*`. What is left between the picture's face and the nearest one that they make is
    shared among them: by their weights in that pose, and at each vertex by how far the template moves there.
    Expressions of a smile become weaker by what of them the picture shows, for that stays in the face.

    Parameters
    ----------
    face : AlignedFace
        At rest. Its fit still has the smile.
    rig : Rig
        Of that face.
    drawn : (n, 3) float64, mm
        Vertices of the face of the picture.

    Returns
    -------
    Rig
        A new one, with the same neutral face.
    """
    started = time.perf_counter()
    model, deltas = face.model, rig.deltas.copy()
    for k, name in enumerate(rig.names):
        if name.startswith(_SMILING):
            deltas[k] *= max(_LEFT, 1 - float(face.fit.expression[model.expression_index(name)]))
    opening = [rig.names.index(name) for name in OPENING if name in rig.names]
    names = tuple(rig.names[k] for k in opening)
    openers = dataclasses.replace(rig, names=names, deltas=deltas[opening])
    weights = fit_pose(openers, drawn, face.region("skin"))
    jaw = rig.neutral + deltas[rig.names.index("jawOpen")]
    opened = lips_apart(model, drawn) / max(lips_apart(model, jaw), 1e-9)
    lips = np.array([name != "jawOpen" for name in names])  # more of the jaw than there is would be taken from it again
    weights = np.maximum(weights, lips * _FLOOR * min(1.0, opened / _OPEN))
    lack = drawn - rig.neutral - np.tensordot(weights, openers.deltas.astype(np.float64), 1)
    lack[~(face.region("skin") | face.region("mouth_cavity"))] = 0
    able = weights[:, None] * _leads(model, names)
    total = weights @ able
    lack *= np.minimum(1, total / _ABLE)[:, None]
    for k, own in zip(opening, able, strict=True):
        deltas[k] += (own / np.maximum(total, 1e-9))[:, None] * lack
    return rig.changed(started, deltas=deltas)


def _leads(model: MorphableModel, names: tuple[str, ...]) -> np.ndarray:
    """How far each expression moves each vertex of the template, in terms of the one that moves it most, (k, n)."""
    rows = [model.expression_index(name) for name in names]
    motion = np.linalg.norm(model.expression[rows], axis=2)
    motion /= motion.max(1, keepdims=True)
    return np.asarray(motion / np.maximum(motion.max(0), 1e-9) * motion_shares(model)[rows])
