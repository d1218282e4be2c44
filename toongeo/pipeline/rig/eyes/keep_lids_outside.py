"""Lids that slide over the eyeballs.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time

import numpy as np
import scipy.sparse as sp

from toongeo.model.anatomy.eye_patch import sagitta
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.rig.skin.neighbour_means import neighbour_means

__all__ = ["CLEARANCE", "SHUT", "cleared", "keep_lids_outside", "outwards", "shortfall"]

CLEARANCE = 0.01  # of the radius: how far skin stays off an eyeball on its way
_NEAR = 2.0  # radii from an eyeball's centre: skin farther from it does not come to it
SHUT = 0.05  # of the radius: how far skin stays off when the eye is shut
_PAIRED_CLEARANCE = 0.03  # of the radius: what an expression leaves of it
_PAIRED = 2.0  # from closed lids an expression must be clear up to this weight, so that two at once are
_ROUNDS, _SMOOTHED = 6, 3  # of pushing out; the first of these spread it
_SHORTEST = 0.05  # of the way: what is inside earlier than that is pushed as if it were there


def keep_lids_outside(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Keep the skin off the eyeballs, all the way from the neutral face to each expression, the gaze included.

    A blendshape moves skin on straight lines, which cut the corner that a real lid goes around. Each vertex that comes
    into an eyeball on its way has the end of the way moved outwards until it passes by, and the skin
    around follows. Several expressions at once add their deltas and may still touch an eyeball.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        Its neutral skin must be outside (:func:`~toongeo.pipeline.rig.eyes.seat_lids.seat_lids`).
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only skin around the eyes differs.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig, eyes = tg.fit_lids(face, tg.build_rig(face))
    >>> clear = tg.keep_lids_outside(face, rig, eyes)
    >>> bool(abs(clear.deltas - rig.deltas).max() < 0.5)  # mm: fit_lids has done it already
    True
    """
    started = time.perf_counter()
    deltas, gaze, skin = rig.deltas.copy(), rig.gaze.copy(), face.region("skin")
    dips = sagitta(face.model, rig.neutral)
    for side, name in enumerate(SIDES):
        radius, offset = eyes.radii[side], rig.neutral - eyes.centres[side]
        near = np.flatnonzero(skin & (np.linalg.norm(offset, axis=1) < _NEAR * radius))
        spread, start = neighbour_means(face.model)[near][:, near], offset[near]
        clear = np.minimum(radius * (1 + CLEARANCE) + dips[near] / radius, np.linalg.norm(start, axis=1))
        blink = rig.names.index(f"eyeBlink{name.capitalize()}")
        deltas[blink, near] = cleared(start, deltas[blink, near], clear, spread)
        stretched = sagitta(face.model, rig.neutral + deltas[blink])[near] / radius
        shut = start + deltas[blink, near]
        shut += outwards(shut, radius * (1 + SHUT) + stretched)
        clear_shut = np.minimum(radius * (1 + _PAIRED_CLEARANCE) + stretched, np.linalg.norm(shut, axis=1))
        for shapes in (deltas, gaze):
            for k in np.flatnonzero(np.any(shapes[:, near], axis=(1, 2))):
                way = cleared(start, shapes[k, near], clear, spread)
                shapes[k, near] = cleared(shut, _PAIRED * way, clear_shut, spread) / _PAIRED
        deltas[blink, near] = shut - start
    return rig.changed(started, deltas=deltas, gaze=gaze)


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
    far = np.maximum(np.linalg.norm(start, axis=1) - radius, 0.0)
    may = np.flatnonzero((way**2).sum(1) > far**2)
    reached = np.zeros(len(way), bool)
    reached[may] = shortfall(start[may], way[may], radius[may]).any(1)
    if not reached.any():
        return way
    for _ in range(_SMOOTHED):
        reached |= spread @ reached > 0
    if 2 * reached.sum() < len(reached):
        at, way = np.flatnonzero(reached), way.copy()
        way[at] = cleared(start[at], way[at], radius[at], spread[at][:, at])
        return way
    for k in range(_ROUNDS):
        lack = shortfall(start, way + change, radius)
        if not lack.any():
            break
        change += lack
        if k < _SMOOTHED:
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
    out = (radius / np.maximum(distance, 1e-9) - 1) / np.maximum(share, _SHORTEST)
    return np.asarray(np.where(inside, out, 0.0)[:, None] * nearest)


def outwards(offset: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Shifts (k, 3) that bring offsets (k, 3) from a centre out to a distance (k,), where they are nearer."""
    distance = np.linalg.norm(offset, axis=1)
    return np.asarray(np.maximum(radius / np.maximum(distance, 1e-9) - 1, 0.0)[:, None] * offset)
