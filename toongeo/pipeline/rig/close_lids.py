"""Lids that close over this face's eyes."""

import dataclasses
import time
from dataclasses import dataclass

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.clear_lids import CLEARANCE, shortfall
from toongeo.pipeline.rig.eye_patch import eye_patch
from toongeo.pipeline.rig.fit_eyes import SIDES, Eyes
from toongeo.pipeline.rig.lid_rings import lid_rings
from toongeo.pipeline.rig.rig import Rig

TRAVEL = np.radians(40.0)  # about the eyeball: what is more than this the lower lid takes over, up to half of the way
OVERLAP, LIFT = 0.03, 0.03  # of the radius: by how much the upper lid hangs over the lower one, and before it
TAPER = 0.12  # of the way from corner to corner over which both die out
ROUNDS = 8  # of moving the meeting line out


def close_lids(face: AlignedFace, rig: Rig, eyes: Eyes) -> Rig:
    """Make ``eyeBlinkLeft`` and ``eyeBlinkRight`` close the eyes of this face.

    Deformation transfer keeps rotations and stretches, not contacts: an eye that is drawn taller than the template's
    stays open when it blinks. At weight 1 both lids are therefore brought to a line where they meet, the upper one over
    the lower one like a tile, and the skin around the eye follows by Laplacian deformation. The line is where the
    lower lid comes to lie by the transfer, or higher where the upper lid would have too far to go; and so far before
    the eyeball that the straight ways of a blendshape to it stay outside.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        Its neutral lids must lie on the eyeballs (:func:`~toongeo.pipeline.rig.seat_lids.seat_lids`).
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only the two blinks differ, and only around the eyes.
    """
    started = time.perf_counter()
    deltas = rig.deltas.copy()
    for side, name in enumerate(SIDES):
        blink = rig.names.index(f"eyeBlink{name.capitalize()}")
        rings, patch = lid_rings(face.model, name), eye_patch(face.model, name)
        start, end = (V - eyes.centres[side] for V in (rig.neutral, rig.neutral + deltas[blink]))
        upper, lower = _met(start[rings.upper], start[rings.lower], end[rings.lower], eyes.radii[side])
        closed = np.empty_like(end)
        closed[rings.lower], closed[rings.upper] = lower, upper
        shape = patch.pulled(end, rings.vertices, closed[rings.vertices])
        deltas[blink, patch.vertices] = shape - start[patch.vertices]
    report = {**rig.report, "seconds": rig.report["seconds"] + time.perf_counter() - started}
    return dataclasses.replace(rig, deltas=deltas, report=report)


def _met(upper: np.ndarray, lower: np.ndarray, ends: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Where the rows of upper (3, k, 3) and lower (3, m, 3) lid come to lie when they have met.

    All are offsets from the eyeball's centre. ``ends`` (3, m, 3) is where the transfer takes the lower lid.
    """
    at_upper, at_lower = _along(upper[0]), _along(lower[0])
    start, end = _unit(upper[0]), _unit(_at(at_upper, at_lower, ends[0]))
    angle = np.arccos(np.clip((start * end).sum(1), -1, 1))
    share = np.clip((angle - TRAVEL) / np.maximum(angle, 1e-9), 0.0, 0.5)
    line = _unit(end + share[:, None] * (start - end))
    down = _unit((lower[0].mean(0) - upper[0].mean(0))[None])[0]
    taper = np.minimum(1.0, np.minimum(at_upper, 1 - at_upper) / TAPER)[:, None]
    hanging = _unit(line + OVERLAP * taper * down)
    reach = np.maximum(np.linalg.norm(_at(at_upper, at_lower, ends[0]), axis=1), 0.0)
    reach = np.minimum(reach, radius * 1.05)
    for _ in range(ROUNDS):
        over = _turned(upper, hanging, (reach + radius * LIFT * taper[:, 0])[:, None])
        under = _turned(lower, _unit(_at(at_lower, at_upper, line)), _at(at_lower, at_upper, reach[:, None]))
        lack = [
            np.linalg.norm(shortfall(rows, target - rows, radius * (1 + CLEARANCE)), axis=2).max(0)
            for rows, target in ((upper, over), (lower, under))
        ]
        more = np.maximum(lack[0], np.interp(at_upper, at_lower, lack[1]))
        if not more.any():
            break
        reach = reach + _widened(more)
    return over, under


def _turned(rows: np.ndarray, directions: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """Rows (3, k, 3) turned about the origin so that the first points in directions (k, 3), at a distance (k, 1)."""
    a, b = _unit(rows[0]), directions
    axis, cosine = np.cross(a, b), (a * b).sum(1)[:, None]
    offset = rows - rows[0]
    turned = cosine * offset + np.cross(axis, offset)
    turned += axis * (axis * offset).sum(-1, keepdims=True) / np.maximum(1 + cosine, 1e-9)
    return np.asarray(b * reach + turned)


def _widened(values: np.ndarray) -> np.ndarray:
    """Values (k,) along a rim, where they are less than the mean of their neighbours raised to it."""
    for _ in range(4):
        padded = np.pad(values, 1)
        values = np.maximum(values, (padded[:-2] + padded[2:]) / 2)
    return values


def _at(at: np.ndarray, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Rows of values (m, d), given at shares ``known`` (m,) of a rim, at others (k,)."""
    return np.column_stack([np.interp(at, known, column) for column in values.T])


def _unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def _along(path: np.ndarray) -> np.ndarray:
    """Length along a path of points (k, 3) up to each, as a share of the whole."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    return np.asarray(length / length[-1])
