"""Gaze: eyeballs turned by the ``eyeLook*`` weights of ARKit."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

__all__ = ["GAZE_NAMES", "TURN", "gaze_names", "gaze_rotation", "gaze_weights"]

# Degrees sideways, and up or down, at weight 1; about the range in which a person's eyes move without the head.
TURN = (30.0, 25.0)
_DIRECTIONS = ("In", "Out", "Up", "Down")


def gaze_names(side: str) -> tuple[str, ...]:
    """The four ARKit names that turn one eye.

    Examples
    --------
    >>> gaze_names("left")
    ('eyeLookInLeft', 'eyeLookOutLeft', 'eyeLookUpLeft', 'eyeLookDownLeft')
    """
    return tuple(f"eyeLook{direction}{side.capitalize()}" for direction in _DIRECTIONS)


def gaze_rotation(side: str, weights: Mapping[str, float], turn: ArrayLike = TURN) -> np.ndarray:
    """Rotation (3, 3), model frame, of the ``side`` ("left" or "right") eyeball; names it does not know are ignored.

    ``turn`` (2,) are the degrees sideways, and up or down, at weight 1.

    Examples
    --------
    The left eye that looks out looks to the subject's left, +X:

    >>> (gaze_rotation("left", {"eyeLookOutLeft": 1.0}) @ [0, 0, 1]).round(3)
    array([0.5  , 0.   , 0.866])
    """
    inward, outward, up, down = (weights.get(name, 0.0) for name in gaze_names(side))
    sideways, updown = np.asarray(turn)
    yaw = sideways * (outward - inward) * (1 if side == "left" else -1)
    return Rotation.from_euler("YX", [yaw, updown * (down - up)], degrees=True).as_matrix()


def gaze_weights(side: str, direction: np.ndarray, turn: ArrayLike = TURN) -> dict[str, float]:
    """Weights in [0, 1] of the four names that turn one eye towards a direction (3,); inverse of the rotation.

    Examples
    --------
    >>> {name: round(weight, 3) for name, weight in gaze_weights("left", np.array([0.5, 0, 0.866])).items()}
    {'eyeLookInLeft': 0.0, 'eyeLookOutLeft': 1.0, 'eyeLookUpLeft': 0.0, 'eyeLookDownLeft': 0.0}
    """
    sideways, updown = np.asarray(turn)
    x, y, z = direction / np.linalg.norm(direction)
    outward = np.rad2deg(np.arctan2(x, z)) / sideways * (1 if side == "left" else -1)
    upward = np.rad2deg(np.arcsin(y)) / updown
    weights = (np.clip([-outward, outward, upward, -upward], 0, 1) + 0.0).tolist()  # no -0.0
    return dict(zip(gaze_names(side), weights, strict=True))


GAZE_NAMES = (*gaze_names("left"), *gaze_names("right"))
