"""Gaze: eyeballs turned by the ``eyeLook*`` weights of ARKit."""

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

SIDEWAYS, UPDOWN = 30.0, 25.0  # degrees at weight 1; about the range in which eyes move without the head
DIRECTIONS = ("In", "Out", "Up", "Down")


def gaze_names(side: str) -> tuple[str, ...]:
    """The four ARKit names that turn one eye.

    Examples
    --------
    >>> gaze_names("left")
    ('eyeLookInLeft', 'eyeLookOutLeft', 'eyeLookUpLeft', 'eyeLookDownLeft')
    """
    return tuple(f"eyeLook{direction}{side.capitalize()}" for direction in DIRECTIONS)


def gaze_rotation(side: str, weights: Mapping[str, float]) -> np.ndarray:
    """Rotation (3, 3), model frame, of the ``side`` ("left" or "right") eyeball; names it does not know are ignored.

    Examples
    --------
    The left eye that looks out looks to the subject's left, +X:

    >>> (gaze_rotation("left", {"eyeLookOutLeft": 1.0}) @ [0, 0, 1]).round(3)
    array([0.5  , 0.   , 0.866])
    """
    inward, outward, up, down = (weights.get(name, 0.0) for name in gaze_names(side))
    yaw = SIDEWAYS * (outward - inward) * (1 if side == "left" else -1)
    return Rotation.from_euler("YX", [yaw, UPDOWN * (down - up)], degrees=True).as_matrix()


def gaze_weights(side: str, direction: np.ndarray) -> dict[str, float]:
    """Weights in [0, 1] of the four names that turn one eye towards a direction (3,); inverse of the rotation.

    Examples
    --------
    >>> {name: round(weight, 3) for name, weight in gaze_weights("left", np.array([0.5, 0, 0.866])).items()}
    {'eyeLookInLeft': 0.0, 'eyeLookOutLeft': 1.0, 'eyeLookUpLeft': 0.0, 'eyeLookDownLeft': 0.0}
    """
    x, y, z = direction / np.linalg.norm(direction)
    outward = np.rad2deg(np.arctan2(x, z)) / SIDEWAYS * (1 if side == "left" else -1)
    upward = np.rad2deg(np.arcsin(y)) / UPDOWN
    weights = np.clip([-outward, outward, upward, -upward], 0, 1).tolist()
    return dict(zip(gaze_names(side), weights, strict=True))


GAZE_NAMES = (*gaze_names("left"), *gaze_names("right"))
