"""Teeth and tongue that move with this face's jaw and stay in its mouth.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/lips.py``).
"""

import time
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from toongeo.model import MorphableModel
from toongeo.model.anatomy.lip_line import lip_line
from toongeo.model.anatomy.parts import TEETH_AND_TONGUE
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.align.keep_teeth_inside import enclosed
from toongeo.pipeline.rig.rig import Rig

__all__ = ["hang_teeth"]

_NEEDS = (*TEETH_AND_TONGUE, "mouth_cavity", "jaw", "jawOpen", "mouthClose")
_STILL_MM = 0.05  # on the template: what an expression moves less than this it holds still
_NEAR_MM = 60.0  # on the template: skin that teeth could come through lies so near to the lips
_EVERY = 4  # every so manieth vertex of teeth and tongue is looked at first
_COVER_MM = 3.0  # seen from the front, skin so near to a point covers it
_NEIGHBOURS = 4  # skin vertices beside a point, of which the foremost counts
_CLEAR_MM = 1.0  # what is farther behind the skin has not come out
_SHARES = (0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0)  # of the way back to the middle of the tongue that are tried


def hang_teeth(face: AlignedFace, rig: Rig) -> Rig:
    """Keep the upper teeth in the skull, let the lower ones and the tongue go as far as the chin does, all inside.

    Transfer turns a loose part as on the template, but does not tell how far it goes. The skin of the chin does: the
    displacement of a part's middle is that of the template, times the ratio of how far the chins go. Where an
    expression at 1, or ``mouthClose`` with ``jawOpen``, would have a part come through the skin, the part goes back as
    a whole, on the way to where the middle of the tongue is at rest, until it does not; the upper teeth, which no
    expression moves, do so in the neutral face. The tongue may come out in ``tongueOut``.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        With lips that are closed where they should be (:func:`seal_lips`).

    Returns
    -------
    Rig
        A new one; only teeth and tongue differ. The same, if the model lacks one of these parts.
    """
    if not face.model.has(*_NEEDS):
        return rig
    started = time.perf_counter()
    neutral, deltas = rig.neutral.copy(), rig.deltas.copy()
    _follow_chin(face.model, rig.names, deltas)
    _keep_inside(face.model, rig.names, neutral, deltas)
    return rig.changed(started, neutral=neutral, deltas=deltas)


def _follow_chin(model: MorphableModel, names: tuple[str, ...], deltas: np.ndarray) -> None:
    """Give teeth and tongue the displacements that suit the chin's, in place."""
    chin = model.region("jaw")
    held = {part: model.region(part) for part in TEETH_AND_TONGUE}
    for k, name in enumerate(names):
        shape = model.expression[model.expression_index(name)]
        ratio = 1.0
        if name.startswith("jaw"):
            ratio = float((shape[chin] * deltas[k, chin]).sum() / (shape[chin] ** 2).sum())
        for part in held.values():
            if np.abs(shape[part]).max() < _STILL_MM:
                deltas[k, part] = 0.0
            else:
                deltas[k, part] += ratio * shape[part].mean(0) - deltas[k, part].mean(0)


def _keep_inside(model: MorphableModel, names: tuple[str, ...], neutral: np.ndarray, deltas: np.ndarray) -> None:
    """Draw parts that come through the skin back into the mouth, in place."""
    skin = _skin_near_mouth(model)
    held = {part: np.flatnonzero(model.region(part)) for part in TEETH_AND_TONGUE}
    some = np.concatenate([part[::_EVERY] for part in held.values()])
    of_part = np.repeat(TEETH_AND_TONGUE, [len(part[::_EVERY]) for part in held.values()])
    refuge = neutral[held["tongue"]].mean(0)
    jaw, close = names.index("jawOpen"), names.index("mouthClose")
    mouth = np.r_[lip_line(model).vertices, some]
    for k in np.flatnonzero(np.abs(deltas[:, mouth]).max((1, 2)) > _CLEAR_MM):
        V = neutral + deltas[k] + (deltas[jaw] if k == close else 0.0)
        for part in np.unique(of_part[_near_front(V[skin], V[some])]):
            if part == "tongue" and names[k] == "tongueOut":
                continue
            way = _way_back(model, V, V[held[part]], refuge)
            if part == "teeth_upper":
                neutral[held[part]] += way
            else:
                deltas[k, held[part]] += way


def _near_front(skin: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which of the points (k, 3) the skin (s, 3) does not cover well, as seen from the front."""
    tree = cKDTree(skin[:, :2], balanced_tree=False, compact_nodes=False)
    distance, near = tree.query(points[:, :2], _NEIGHBOURS, distance_upper_bound=_COVER_MM)
    front = np.where(np.isfinite(distance), np.r_[skin[:, 2], 0.0][near], -np.inf).max(1)
    return np.isfinite(front) & (points[:, 2] > front - _CLEAR_MM)


def _way_back(model: MorphableModel, V: np.ndarray, points: np.ndarray, refuge: np.ndarray) -> np.ndarray:
    """The shortest way (3,) towards a refuge on which points (k, 3) come to lie inside the skin."""
    inside = enclosed(model, V, points)
    if inside.all():
        return np.zeros(3)
    whole = refuge - points.mean(0)
    telling = np.vstack([points[~inside], points[::_EVERY]])
    for share in _SHARES:
        if enclosed(model, V, telling + share * whole).all():
            break
    return np.asarray(share * whole)


@lru_cache(maxsize=4)
def _skin_near_mouth(model: MorphableModel) -> np.ndarray:
    near = cKDTree(model.mean[lip_line(model).vertices]).query(model.mean)[0] < _NEAR_MM
    return np.flatnonzero(near & model.region("face"))
