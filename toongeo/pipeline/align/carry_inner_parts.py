"""Sockets, mouth cavity, teeth and tongue follow the openings they lie behind.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/alignment.py``, ``benchmarks/lips.py``).
"""

import numpy as np
from scipy.spatial import cKDTree

from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel
from toongeo.model.anatomy.parts import MOUTH_PARTS, SOCKETS
from toongeo.model.anatomy.rims import opening_rim

__all__ = ["carry_inner_parts"]

_REACH = 0.5  # of the lips' size: over this distance into the mouth the lips' own deformation dies out


def carry_inner_parts(model: MorphableModel, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Place what no landmark sees by how the rim before it moved.

    Parameters
    ----------
    model : MorphableModel
    before, after : (n, 3) float, mm, model frame
        Vertices before and after the skin was deformed.

    Returns
    -------
    (n, 3) float64
        ``after`` with sockets, mouth cavity, teeth and tongue moved, as far as the model has them.
    """
    carried = after.copy()
    for name, eye in zip(SOCKETS, model.eyes, strict=False):
        if model.has(name):
            _carry_socket(model, name, eye.radius, before, carried)
    if model.has("mouth_cavity"):
        _carry_mouth(model, before, carried)
    return carried


def _carry_socket(model: MorphableModel, name: str, radius: float, before: np.ndarray, carried: np.ndarray) -> None:
    """A socket is a band behind the lids: each vertex keeps its offset from the nearest vertex of the rim.

    An eye that is drawn larger has its rim out on the cheek or the temple, where the band would come through the skin:
    the more the rim has grown, the more the offsets turn inwards, to the eyeball.
    """
    rim, inside = opening_rim(model, name), np.flatnonzero(model.region(name))
    nearest = rim[cKDTree(before[rim]).query(before[inside])[1]]
    offset = before[inside] - before[nearest]
    sizes = [np.linalg.norm(V[rim] - V[rim].mean(0), axis=1).mean() for V in (before, carried)]
    growth = max(1.0, sizes[1] / sizes[0])
    inward = carried[rim].mean(0) - [0, 0, growth * radius] - carried[nearest]
    inward *= np.linalg.norm(offset, axis=1, keepdims=True) / np.linalg.norm(inward, axis=1, keepdims=True)
    carried[inside] = carried[nearest] + offset / growth + (1 - 1 / growth) * inward


def _carry_mouth(model: MorphableModel, before: np.ndarray, carried: np.ndarray) -> None:
    """The mouth turns and scales with the lips, so that teeth stay teeth.

    Along no axis does it grow more than the lower face around it, which must hold it. Next to the lips its wall also
    takes what this leaves of their motion, so that no gap opens.
    """
    rim = opening_rim(model, "mouth_cavity")
    scale, rotation, _ = similarity(before[rim], carried[rim])
    middle, new_middle = before[rim].mean(0), carried[rim].mean(0)
    axes = np.full(3, scale)
    for around in (model.region(name) for name in ("jaw", "mouth") if model.has(name)):
        spread = ((before[around] - middle) ** 2).mean(0)
        new_spread = (((carried[around] - new_middle) @ rotation) ** 2).mean(0)
        axes = np.minimum(axes, np.sqrt(new_spread / spread))

    def placed(V: np.ndarray) -> np.ndarray:
        return ((V - middle) * axes) @ rotation.T + new_middle

    residual = carried[rim] - placed(before[rim])
    for name in MOUTH_PARTS:
        inside = model.region(name)
        carried[inside] = placed(before[inside])
    reach = _REACH * np.linalg.norm(before[rim] - middle, axis=1).mean()
    wall = model.region("mouth_cavity")
    distance, nearest = cKDTree(before[rim]).query(before[wall])
    carried[wall] += np.exp(-((distance / reach) ** 2))[:, None] * residual[nearest]
