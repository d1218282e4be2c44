"""What people get wrong in landmarks, said before a fit goes astray."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.landmark_array import landmark_array
from toongeo.io.landmarks.frontal_layout import frontal_layout, frontal_pose
from toongeo.io.landmarks.order_doubts import order_doubts

__all__ = ["check_landmarks"]

# Thresholds. "Misfit" is the part of the points' spread that no similarity maps from the frontal layout,
# 0..1: portraits and strong caricatures have 0.1-0.35, a yaw of 60 degrees 0.6, points in another order
# 0.94 and more; with the wrong handedness a face has 0.95 and more, and a full profile has 0.8 with either.
_MISFIT_REFUSED = 0.88
_MISFIT_DOUBTED = 0.55
_HANDEDNESS_MARGIN = 0.1
_ROLL_DOUBTED = 100.0  # degrees
_SPREAD_PX = 2.0
_FLATNESS = 0.1
_FEWEST = 6
_SHARE_OUTSIDE = 1 / 3

# What makes a face left-handed, and what to do about it. Columns of each matrix: where x and y of the
# layout point.
_REFLECTIONS = (
    (
        [[-1, 0], [0, 1]],
        "left and right are mirrored: points 0-7, 17-21 and 36-41 are the subject's right side, on the left "
        "of the picture; exchange the two sides, or flip x with the picture",
    ),
    ([[1, 0], [0, -1]], "y points up; expected pixels with y down (height - 1 - y)"),
    ([[0, 1], [1, 0]], "the columns are (y, x); expected (x, y)"),
    ([[0, -1], [-1, 0]], "the columns are (y, x) and run backwards; expected (x, y) with y down"),
)


def check_landmarks(landmarks: ArrayLike, image_shape: Sequence[int] | None = None) -> list[str]:
    """Refuse landmarks that cannot be a face in iBUG-68 order; doubt those that may not be.

    The usable points are compared with a frontal face by the best similarity with and without a reflection,
    so a head may be rolled, turned, and caricatured.

    Parameters
    ----------
    landmarks
        (68, 2) px; NaN rows are missing points.
    image_shape
        Shape of the picture, (H, W) or (H, W, channels); None: whether the points lie in it is not checked.

    Returns
    -------
    list of str
        Warnings; empty if nothing is suspicious. Doubted are: points outside the picture, points just outside
        (0- or 1-based?), several points in one place, a part whose sides are exchanged, a head turned far or
        upside down.

    Raises
    ------
    ValueError
        Wrong shape or number, infinity, fewer than 6 usable points, points equal or on one line, left and
        right mirrored, y up, (y, x) order, points far outside the picture or a third of them outside,
        another landmark order.

    Examples
    --------
    >>> check_landmarks(np.zeros((51, 2)))
    Traceback (most recent call last):
        ...
    ValueError: landmarks: expected 68 points in iBUG order, got 51
    (iBUG-68 without the jaw: put NaN in rows 0-16)
    """
    points = landmark_array(landmarks)
    usable = np.flatnonzero(np.isfinite(points[:, 0]))
    if len(usable) < _FEWEST:
        raise ValueError(f"landmarks: expected at least {_FEWEST} points that are not NaN, got {len(usable)}")
    spread = np.ptp(points[usable], axis=0)
    if spread.max() < _SPREAD_PX:
        raise ValueError(
            "landmarks: expected a face in pixels (not fractions of the picture's size), but the points span "
            f"{spread[0]:.3g} x {spread[1]:.3g} px"
        )
    pose, misfit, mirrored_misfit = frontal_pose(points[usable], frontal_layout().points[usable])
    if mirrored_misfit < min(misfit - _HANDEDNESS_MARGIN, _MISFIT_REFUSED):
        raise ValueError(f"landmarks: {_reflection(pose)}")
    warnings = [] if image_shape is None else _outside(points, usable, image_shape)
    _refuse_flat(points[usable])
    if misfit > _MISFIT_REFUSED:
        raise ValueError(
            "landmarks: expected a face in iBUG-68 order, but the points do not form one "
            f"(misfit {misfit:.2f}, at most {_MISFIT_REFUSED}): another scheme, or another order?"
        )
    if misfit > _MISFIT_DOUBTED:
        warnings.append(f"landmarks are far from a frontal face (misfit {misfit:.2f}): a profile, another order?")
    return warnings + _doubts(points, usable, pose)


def _refuse_flat(points: NDArray[np.float64]) -> None:
    singular = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if singular[1] < _FLATNESS * singular[0]:
        raise ValueError("landmarks: expected a face, but all points lie on one line")


def _reflection(pose: NDArray[np.float64]) -> str:
    return max(_REFLECTIONS, key=lambda reflection: float(np.sum(pose * np.array(reflection[0]))))[1]


def _outside(points: NDArray[np.float64], usable: NDArray[np.int64], image_shape: Sequence[int]) -> list[str]:
    if len(image_shape) not in (2, 3) or min(image_shape[:2]) < 1:
        raise ValueError(f"image_shape: expected (H, W) or (H, W, channels), got {tuple(image_shape)}")
    height, width = image_shape[:2]
    size = np.array([width, height])
    # Distance beyond the outermost pixel centres, per point.
    beyond = np.maximum(-points, points - (size - 1)).max(axis=1)[usable]
    worst = int(np.argmax(beyond))
    x, y = points[usable[worst]]
    outside = int(np.count_nonzero(beyond > 1))
    picture = f"the picture of {width} x {height} px"
    farthest = f"{usable[worst]} at ({x:.6g}, {y:.6g})"
    if outside > _SHARE_OUTSIDE * len(usable) or beyond[worst] > np.hypot(width, height):
        raise ValueError(
            f"landmarks: {outside} of {len(usable)} points lie outside {picture}, farthest {farthest}: "
            "points of another picture or size?"
        )
    if outside:
        return [f"{outside} landmarks lie outside {picture}, farthest {farthest}"]
    if beyond[worst] > 0:
        doubt = "was 1 subtracted twice?" if min(x, y) < 0 else "was 1 not subtracted?"
        return [f"landmark {farthest} lies just outside {picture}: {doubt}"]
    return []


def _doubts(points: NDArray[np.float64], usable: NDArray[np.int64], pose: NDArray[np.float64]) -> list[str]:
    doubts = []
    places, counts = np.unique(points[usable] @ (1, 1j), return_counts=True)  # quicker than unique rows
    if counts.max() > 2:
        x, y = places[np.argmax(counts)].real, places[np.argmax(counts)].imag
        doubts.append(f"{counts.max()} landmarks lie at ({x:g}, {y:g}): a missing point must be a row of NaN")
    if np.linalg.det(pose) < 0:  # nearly a profile: neither roll nor sides can be told
        return doubts
    roll = np.degrees(np.arctan2(pose[1, 0], pose[0, 0]))
    if abs(roll) > _ROLL_DOUBTED:
        doubts.append(f"the face is turned by {roll:.0f} degrees in the picture: are both axes as expected?")
    return doubts + order_doubts(points, pose)
