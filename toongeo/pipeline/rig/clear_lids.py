"""Lids that slide over the eyeballs."""

import dataclasses
import time
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eye_patch import sagitta
from toongeo.pipeline.rig.fit_eyes import SIDES, Eyes
from toongeo.pipeline.rig.rig import Rig

CLEARANCE = 0.01  # of the radius: how far skin stays off an eyeball on its way
NEAR = 3.0  # radii from an eyeball's centre: skin farther from it does not come to it
ROUNDS = 6  # of pushing out and smoothing
SHORTEST = 0.05  # of the way: what is inside earlier than that is pushed as if it were there


def clear_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Keep the skin off the eyeballs, all the way from the neutral face to each expression, the gaze included.

    A blendshape moves skin on straight lines, which cut the corner that a real lid goes around. Each vertex that comes
    into an eyeball on its way has the end of the way moved outwards until it passes by, and the skin
    around follows. Several expressions at once add their deltas and may still touch an eyeball.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        Its neutral skin must be outside (:func:`~toongeo.pipeline.rig.seat_lids.seat_lids`).
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only skin around the eyes differs.
    """
    started = time.perf_counter()
    deltas, gaze, skin = rig.deltas.copy(), rig.gaze.copy(), face.region("skin")
    dips = sagitta(face.model, rig.neutral)
    for side in range(len(SIDES)):
        offset = rig.neutral - eyes.centres[side]
        near = np.flatnonzero(skin & (np.linalg.norm(offset, axis=1) < NEAR * eyes.radii[side]))
        spread = _spread(face.model)[near][:, near]
        clear = eyes.radii[side] * (1 + CLEARANCE + dips[near] / eyes.radii[side] ** 2)
        clear = np.minimum(clear, np.linalg.norm(offset[near], axis=1))
        for shapes in (deltas, gaze):
            moved = np.flatnonzero(np.any(shapes[:, near], axis=(1, 2)))
            for k in moved:
                shapes[k, near] = cleared(offset[near], shapes[k, near], clear, spread)
    report = {**rig.report, "seconds": rig.report["seconds"] + time.perf_counter() - started}
    return dataclasses.replace(rig, deltas=deltas, gaze=gaze, report=report)


def cleared(start: np.ndarray, way: np.ndarray, radius: np.ndarray, spread: sp.csr_array) -> np.ndarray:
    """Ways (k, 3) with their ends moved out, so that points that set out at ``start`` (k, 3) pass by a sphere.

    Parameters
    ----------
    start : (k, 3) float, mm
        From the sphere's centre; outside.
    way : (k, 3) float, mm
    radius : (k,) float, mm
        Of the sphere that each of them passes by.
    spread : (k, k) sparse
        Means over neighbours, by which the change of a way spreads.
    """
    change = np.zeros(way.shape)
    for k in range(ROUNDS):
        lack = shortfall(start, way + change, radius)
        if not lack.any():
            break
        change += lack
        if k < ROUNDS - 3:
            mean = spread @ change
            wider = (mean**2).sum(1) > (change**2).sum(1)
            change[wider] = mean[wider]
    return way + change


def shortfall(start: np.ndarray, way: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """What the ends of ways (k, 3) lack for their nearest points to be ``radius`` (k,) from the origin."""
    length2 = np.maximum((way**2).sum(1), 1e-12)
    share = np.clip(-(start * way).sum(1) / length2, 0.0, 1.0)
    nearest = start + share[:, None] * way
    distance = np.linalg.norm(nearest, axis=1)
    inside = (distance < radius) & (share > 0)
    out = (radius / np.maximum(distance, 1e-9) - 1) / np.maximum(share, SHORTEST)
    return np.asarray(np.where(inside, out, 0.0)[:, None] * nearest)


@lru_cache(maxsize=4)
def _spread(model: MorphableModel) -> sp.csr_array:
    """Mean over the neighbours of each vertex."""
    A = sp.csr_array(adjacency(model.faces, len(model.mean)), dtype=float)
    return sp.csr_array(sp.diags_array(1 / np.maximum(A.sum(1), 1)) @ A)
