"""The cascade from many starts: their median is steadier than any, their spread tells how far to trust it."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline.landmarks.search.cascade import Cascade
from toongeo.pipeline.landmarks.search.face_crop import CROP_PX, RADIUS_PX
from toongeo.pipeline.landmarks.search.frames import box_of, composed, similarity_onto

__all__ = ["FacePatch", "Passes", "face_patch", "run_passes"]

_PATCH_RADIUS_PX = 45.0  # of the face in the patch: as in the renders the cascade was trained on
_PATCH_MARGIN = 4.5  # radii on each side: the crop's corners, turned and moved
_FIRST_LOOK = 3  # starts: enough to tell a face from clutter
# Starts about a face: shift in radii (x, y) and factor of the radius.
_STARTS = np.array(
    [
        (0, 0, 1),
        (0.12, 0.05, 1.08),
        (-0.12, 0.05, 0.93),
        (0.05, -0.12, 0.95),
        (-0.05, -0.1, 1.07),
    ]
)


@dataclass(frozen=True, eq=False)
class FacePatch:
    """A cut-out `grey` (h, w) uint8 in which a face has the size the cascade knows; `matrix` (2, 3) leads to it."""

    grey: np.ndarray
    matrix: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Passes:
    """`points` (68, 2) px where the passes agree, and the `spread` (68,) of each point among them in radii."""

    points: NDArray[np.float64]
    spread: NDArray[np.float64]


def face_patch(grey: np.ndarray, box: NDArray[np.float64]) -> FacePatch:
    """The neighbourhood of a box (x, y, r), shrunken without aliasing if the face is larger than needed."""
    scale = min(1.0, _PATCH_RADIUS_PX / box[2])
    height, width = grey.shape
    reach = _PATCH_MARGIN * box[2]
    x0, y0 = (int(np.clip(np.floor(c - reach), 0, side - 2)) for c, side in zip(box[:2], (width, height), strict=True))
    x1, y1 = (int(np.clip(np.ceil(c + reach), 2, side)) for c, side in zip(box[:2], (width, height), strict=True))
    part = grey[y0 : max(y1, y0 + 2), x0 : max(x1, x0 + 2)]
    size = [max(2, round(side * scale)) for side in part.shape[::-1]]
    small = part if scale == 1 else cv2.resize(part, size, interpolation=cv2.INTER_AREA)
    sx, sy = small.shape[1] / part.shape[1], small.shape[0] / part.shape[0]
    matrix = np.array([[sx, 0, sx * (0.5 - x0) - 0.5], [0, sy, sy * (0.5 - y0) - 0.5]])
    return FacePatch(np.ascontiguousarray(small), matrix)


def run_passes(
    grey: np.ndarray, points: NDArray[np.float64], cascade: Cascade, *, photo: float = 0.0, first_look: bool = False
) -> Passes:
    """The cascade from five starts about a face found roughly at `points` (68, 2) px, and from their mirror images.

    The parts go on from the median of those, in the picture and in its mirror image; `photo` is the share of those that
    saw no figures. The `first_look` is from three starts, not mirrored, and ends before the parts.
    """
    start, stages = similarity_onto(points, cascade.shape), len(cascade.stages)
    if first_look:
        return _gathered([cascade.rough(grey, _moved(start, move), stages) for move in _STARTS[:_FIRST_LOOK]])
    found = [cascade.rough(grey, _moved(start, move), stages) for move in _STARTS]
    flipped = np.ascontiguousarray(grey[:, ::-1])
    start = similarity_onto(_mirrored(points, grey), cascade.shape)
    found += [_mirrored(cascade.rough(flipped, _moved(start, move), stages), grey) for move in _STARTS]
    rough = _gathered(found)
    here = cascade.refined(grey, rough.points, photo)
    there = _mirrored(cascade.refined(flipped, _mirrored(rough.points, grey), photo), grey)
    apart = np.linalg.norm(here - there, axis=1) / 2 / box_of(rough.points)[2]
    return Passes((here + there) / 2, rough.spread + apart)


def _gathered(found: list[NDArray[np.float64]]) -> Passes:
    median = np.median(np.array(found), axis=0)
    return Passes(median, np.linalg.norm(np.array(found) - median, axis=2).mean(axis=0) / box_of(median)[2])


def _moved(start: NDArray[np.float64], move: NDArray[np.float64]) -> NDArray[np.float64]:
    """A start (2, 3) as if its face were elsewhere by `move`."""
    middle, factor = CROP_PX / 2, 1 / move[2]
    step = np.array([[factor, 0, 0], [0, factor, 0.0]])
    step[:, 2] = middle - factor * (middle + RADIUS_PX * move[:2])
    return composed(step, start)


def _mirrored(points: NDArray[np.float64], grey: np.ndarray) -> NDArray[np.float64]:
    return points[MIRROR] * [-1, 1] + [grey.shape[1] - 1, 0]
