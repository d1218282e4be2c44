"""Ears as large as they are drawn.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import dataclasses
from typing import NamedTuple

import cv2
import numpy as np
from scipy.spatial import cKDTree

from toongeo.geometry.rotations.rotation_exp import rotation_exp
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["fit_ears"]

_SIZES = (1.0, 2.2)  # of the ear that suits the head: a smaller patch is a part of an ear, a larger another thing
_AREA, _SOLID = 0.35, 0.6  # of the ear's own area, and of its hull: less of it is an ear behind hair, or a sideburn
_HIGHER = 0.6  # ear heights that a drawn ear is higher or lower than the head's
_SEEN = 25.0  # degrees by which a head may turn from an ear that is still seen whole
_FLARES = np.radians(np.arange(0, 61, 5))  # turns by which an ear may stand off the head
_ROOT = 0.12  # of an ear's height: over this distance from its root it follows the head
_EDGE = 0.02  # of a mask's pixels at each end, which may be specks


class _DrawnEar(NamedTuple):
    """Of a drawn ear in terms of the head's own: size, how far it is higher (ear heights), how far it reaches out (px
    from the root of the ear, over the ear's own height in px)."""

    size: float
    higher: float
    reach: float


def fit_ears(face: AlignedFace, parse: FaceParse) -> AlignedFace:
    """The face with ears that have the size of those in its picture, and stand as far off the head.

    Each is grown and turned about its root as a whole (a similarity), so that its outline has the height and the reach
    of the drawn one. Ears under hair, and those that a turned head hides, stay; of a head that looks ahead, one that is
    not seen is as the other.

    Parameters
    ----------
    face : AlignedFace
    parse : FaceParse
        Of the picture.

    Returns
    -------
    AlignedFace
        The same object if no ear is seen.
    """
    if not face.model.has("ear_left", "ear_right"):
        return face
    up = np.diff(face.project(np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])), axis=0)[0]
    up /= max(float(np.linalg.norm(up)), 1e-9)
    drawn = {side: _drawn_ear(face, parse, side, up) for side in SIDES if _is_turned_to(face, side)}
    if len(drawn) == len(SIDES):
        first, second = SIDES
        drawn[first], drawn[second] = drawn[first] or drawn[second], drawn[second] or drawn[first]
    vertices = face.vertices
    for side, ear in drawn.items():
        if ear is not None:
            vertices = _fitted(face, vertices, side, ear, up)
    return face if vertices is face.vertices else dataclasses.replace(face, vertices=vertices)


def _is_turned_to(face: AlignedFace, side: str) -> bool:
    """Whether the camera sees an ear; a head with a yaw > 0 shows its right ear."""
    away = face.camera.yaw if side == "left" else -face.camera.yaw
    return away < _SEEN


def _drawn_ear(face: AlignedFace, parse: FaceParse, side: str, up: np.ndarray) -> _DrawnEar | None:
    """The largest patch of the parse's ears beside an ear of the head that may be it."""
    ear, root, out = _places(face, face.vertices, side, up)
    own = ear @ up
    height, middle = float(np.ptp(own)), float(own.max() + own.min()) / 2
    area = float(cv2.contourArea(cv2.convexHull(ear.astype(np.float32))))
    mask = cv2.morphologyEx(parse.mask(FaceLabel.EARS).astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
    best = None
    for label in sorted(range(1, count), key=lambda k: -stats[k, cv2.CC_STAT_AREA]):
        rows, columns = np.nonzero(labels == label)
        at = np.column_stack([columns, rows]).astype(float)
        if len(at) < _AREA * area or len(at) < _SOLID * cv2.contourArea(cv2.convexHull(at.astype(np.float32))):
            continue
        low, high = np.quantile(at @ up, [_EDGE, 1 - _EDGE])
        size, higher = (high - low) / height, ((high + low) / 2 - middle) / height
        reach = float(np.quantile((at - root) @ out, 1 - _EDGE)) / height
        if _SIZES[0] <= size <= _SIZES[1] and abs(higher) <= _HIGHER and np.median((at - root) @ out) > 0:
            best = _DrawnEar(float(size), float(higher), reach)
            break
    return best


def _places(face: AlignedFace, V: np.ndarray, side: str, up: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of an ear, px: its vertices (k, 2), the middle (2,) of its root, and the unit vector (2,) outwards."""
    out = np.array([-up[1], up[0]])
    middle = face.project(V[face.region("face")]).mean(0)
    root = face.project(V[_root(face, side)]).mean(0)
    out *= np.sign((root - middle) @ out) or 1.0
    return face.project(V[face.region(f"ear_{side}")]), root, out


def _root(face: AlignedFace, side: str) -> np.ndarray:
    """Vertices around an ear, where it grows out of the head."""
    ear, F = face.region(f"ear_{side}"), face.faces
    border = F[ear[F].any(1) & ~ear[F].all(1)]
    return np.unique(border[~ear[border]])


def _fitted(face: AlignedFace, V: np.ndarray, side: str, drawn: _DrawnEar, up: np.ndarray) -> np.ndarray:
    """Vertices (n, 3) with an ear grown and turned."""
    ear, root = face.region(f"ear_{side}"), _root(face, side)
    pivot, height = V[root].mean(0), float(np.ptp(V[ear, 1]))
    px, place, out = _places(face, V, side, up)
    tall = float(np.ptp(px @ up))
    sign = -1.0 if side == "left" else 1.0  # about +Y, so that an ear's back goes outwards
    best, placed = np.inf, V
    for flare in _FLARES:
        turn = drawn.size * rotation_exp(np.array([[0.0], [sign * flare], [0.0]]))[:, :, 0]
        moved = (V - pivot) @ turn.T + pivot + [0.0, drawn.higher * height, 0.0]
        reach = float(((face.project(moved[ear]) - place) @ out).max()) / tall
        if abs(reach - drawn.reach) < best:
            best, placed = abs(reach - drawn.reach), moved
    away, nearest = cKDTree(V[root]).query(V[ear])
    stays = np.exp(-((away / (_ROOT * height)) ** 2))[:, None]
    kept = V.copy()
    kept[ear] = placed[ear] + stays * (V - placed)[root][nearest]
    return kept
