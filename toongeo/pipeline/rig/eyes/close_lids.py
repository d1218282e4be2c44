"""Lids that close over this face's eyes.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/contacts.py``).
"""

import time

import numpy as np

from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.anatomy.eye_patch import eye_patch
from toongeo.model.anatomy.lid_rings import LidRings, lid_rings, opening_height
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.eyes.keep_lids_outside import CLEARANCE, SHUT
from toongeo.pipeline.rig.rig import Rig

__all__ = ["close_lids"]

_TRAVEL = np.radians(40.0)  # about the eyeball: what is more than this the lower lid takes over, up to half of the way
_OVERLAP, _LIFT = 0.02, 0.04  # of the radius: by how much the upper lid hangs over the lower one, and before it
_TAPER = 0.12  # of the way from corner to corner over which both die out
_FREE = 5  # columns at each corner
_RESTING = (0.01, 0.03)  # of the radius: least and most that the transfer may leave the lids farther off when shut
_STEEPEST = np.radians(60.0)  # beyond which a meeting line farther out would not help


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
        Its neutral lids must lie on the eyeballs (:func:`~toongeo.pipeline.rig.eyes.seat_lids.seat_lids`).
    eyes : Eyes

    Returns
    -------
    Rig
        A new one; only the two blinks differ, and only around the eyes.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig, eyes = tg.fit_lids(face, tg.build_rig(face), close=False)
    >>> closing = tg.close_lids(face, rig, eyes)
    >>> [name for name, a, b in zip(rig.names, rig.deltas, closing.deltas) if (a != b).any()]
    ['eyeBlinkLeft', 'eyeBlinkRight']
    """
    started = time.perf_counter()
    deltas = rig.deltas.copy()
    for side, name in enumerate(SIDES):
        blink = rig.names.index(f"eyeBlink{name.capitalize()}")
        rings, patch = lid_rings(face.model, name), eye_patch(face.model, name)
        deltas[blink] *= _gain(rig.neutral, deltas[blink], rings)
        start, end = (V - eyes.centres[side] for V in (rig.neutral, rig.neutral + deltas[blink]))
        upper, lower = _met(start[rings.upper], start[rings.lower], end[rings.lower], eyes.radii[side])
        closed = np.empty_like(end)
        closed[rings.lower], closed[rings.upper] = lower, upper
        # Towards the corners the outer rows are left to follow: those of the two lids share the corner's few vertices.
        held = np.unique(
            np.r_[
                rings.upper[0],
                rings.lower[0],
                rings.upper[1:, _FREE:-_FREE].ravel(),
                rings.lower[1:, _FREE:-_FREE].ravel(),
            ]
        )
        shape = patch.pulled(end, held, closed[held])
        deltas[blink, patch.vertices] = shape - start[patch.vertices]
    return rig.changed(started, deltas=deltas)


def _gain(V: np.ndarray, blink: np.ndarray, rings: LidRings) -> float:
    """How much of a blink is enough: that of the template would take the lids of a narrow eye through each other."""
    upper, lower = rings.upper[0], rings.lower[0]
    closing = blink[upper] - interpolated(arc_shares(V[upper]), arc_shares(V[lower]), blink[lower])
    return min(1.0, opening_height(V[upper], V[lower]) / max(float(np.linalg.norm(closing, axis=1).max()), 1e-9))


def _met(upper: np.ndarray, lower: np.ndarray, ends: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Where the rows of upper (3, k, 3) and lower (3, m, 3) lid come to lie when they have met.

    All are offsets from the eyeball's centre. ``ends`` (3, m, 3) is where the transfer takes the lower lid.
    """
    at_upper, at_lower = arc_shares(upper[0]), arc_shares(lower[0])
    start, end = _unit(upper[0]), _unit(interpolated(at_upper, at_lower, ends[0]))
    angle = _angle(start, end).max()
    line = _unit(end + min(0.5, max(0.0, 1 - _TRAVEL / angle)) * (start - end))
    down = _unit(lower[0].mean(0) - upper[0].mean(0))
    taper = np.minimum(1.0, np.minimum(at_upper, 1 - at_upper) / _TAPER)[:, None]
    hanging, meeting = _unit(line + _OVERLAP * taper * down), _unit(interpolated(at_lower, at_upper, line))
    rest = np.clip(np.linalg.norm(ends[0], axis=1), *(radius * (1 + SHUT + np.array(_RESTING))))
    reach = np.maximum.reduce(
        [
            np.interp(at_upper, at_lower, np.maximum(rest, _passing(lower, meeting, radius))),
            _passing(upper, hanging, radius),
        ]
    )
    reach = _widened(reach)[:, None]
    under = _turned(lower, meeting, interpolated(at_lower, at_upper, reach))
    before = np.interp(at_upper, at_lower, np.linalg.norm(under, axis=2).max(0))[:, None] - reach
    return _turned(upper, hanging, reach + np.sqrt(taper) * (before + radius * _LIFT)), under


def _passing(rows: np.ndarray, directions: np.ndarray, radius: float) -> np.ndarray:
    """How far out in directions (k, 3) straight ways from rows (r, k, 3) must end, to pass by a sphere; (k,).

    A way from a distance A touches the sphere of radius R if it turns by arccos(R / A) up to there, and from there to
    its end by the rest of the angle.
    """
    clear = radius * (1 + CLEARANCE)
    free = np.arccos(np.clip(clear / np.linalg.norm(rows, axis=2), -1, 1))
    rest = np.clip(_angle(_unit(rows), directions) - free, 0.0, _STEEPEST)
    return np.asarray((clear / np.cos(rest)).max(0))


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


def _angle(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles between unit vectors (..., 3)."""
    return np.asarray(np.arccos(np.clip((a * b).sum(-1), -1, 1)))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))
