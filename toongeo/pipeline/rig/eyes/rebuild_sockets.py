"""Sockets that line the gap between lids and eyeballs.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from toongeo.model import MorphableModel
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rims import opening_rim
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.rig import Rig

__all__ = ["DEPTH", "rebuild_sockets"]

DEPTH = 0.95  # of the eyeball's radius: where the lining ends, inside the eyeball


def rebuild_sockets(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Lead the band behind the lids straight to the eyeball, in the neutral face and in each expression.

    As it was carried along, the band ends where the template's eyeball would be: beside a larger or smaller one it
    leaves a hole through which the inside of the head shows, and under a lid that closes over a tall eye it folds and
    comes out. Here each of its vertices lies on a line from a vertex of the lid's rim back into the eyeball, the
    farther in the farther it is from the rim on the template, and the last inside the eyeball.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only the sockets differ.
    """
    started = time.perf_counter()
    neutral, deltas = rig.neutral.copy(), rig.deltas.copy()
    for side, name in enumerate(SIDES):
        band, rim, weights, share = _band(face.model, f"socket_{name}")
        centre, radius = eyes.centres[side], eyes.radii[side]
        start = (weights[..., None] * rig.neutral[rim]).sum(-2)
        moved = (weights[..., None] * rig.deltas[:, rim]).sum(-2)
        neutral[band] = _lined(start, centre, radius, share)
        deltas[:, band] = _lined(start + moved, centre, radius, share) - neutral[band]
    return rig.changed(started, neutral=neutral, deltas=deltas)


def _lined(rim: np.ndarray, centre: np.ndarray, radius: float, share: np.ndarray) -> np.ndarray:
    """Points (..., k, 3) by ``share`` (k,) of the way from points of the rim (..., k, 3) to inside the eyeball.

    The way goes straight back, where that meets the eyeball, so that a lid hides it, and else to its equator.
    """
    offset = rim - centre
    end = offset.copy()
    beside = np.linalg.norm(offset[..., :2], axis=-1, keepdims=True)
    end[..., :2] *= np.minimum(1.0, DEPTH * radius / np.maximum(beside, 1e-9))
    end[..., 2] = np.sqrt(np.maximum((DEPTH * radius) ** 2 - (end[..., :2] ** 2).sum(-1), 0))
    return rim + share[:, None] * (end - offset)


@lru_cache(maxsize=8)
def _band(model: MorphableModel, socket: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (k,) of a socket, the two of its rim (k, 2) that each hangs between, their weights, how far in it is.

    All by the template: a share (k,) of 0 is on the rim, and those at the inner end are at 1. Two vertices of the rim
    and not one, or several of the band would come to lie at one place.
    """
    band, rim = np.flatnonzero(model.region(socket)), opening_rim(model, socket)
    distances, nearest = cKDTree(model.mean[rim]).query(model.mean[band], 2)
    weights = 1 / distances**2
    weights /= weights.sum(1, keepdims=True)
    edges = model.faces[model.region(socket)[model.faces].any(1)]
    inner = np.zeros(len(model.mean), bool)
    pairs = np.sort(edges[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), 1)
    pairs, count = np.unique(pairs, axis=0, return_counts=True)
    inner[pairs[count == 1]] = True
    inner[rim] = False
    to_end = cKDTree(model.mean[inner]).query(model.mean[band])[0]
    return band, rim[nearest], weights, distances[:, 0] / (distances[:, 0] + to_end)
