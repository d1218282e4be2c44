"""Weights of an avatar over time."""

from __future__ import annotations

import numpy as np

from toongeo.avatar.scene import own_shapes
from toongeo.io import SceneAnimation
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.anatomy.neck import NECK_MM
from toongeo.pipeline import Rig

__all__ = ["demo_clip", "weight_clip"]

_FRAMES_PER_SECOND = 30
_LARGEST_WEIGHT, _LONGEST_S = 1e6, 1e6  # as of weights everywhere; eleven days
# The clip: (seconds, weights reached then), linear in between.
_CLIP: tuple[tuple[float, dict[str, float]], ...] = (
    (0.0, {}),
    (0.5, {}),
    (0.6, {"eyeBlinkLeft": 1, "eyeBlinkRight": 1}),
    (0.8, {}),
    (1.4, {"mouthSmileLeft": 1, "mouthSmileRight": 1, "cheekSquintLeft": 0.4, "cheekSquintRight": 0.4}),
    (2.0, {"eyeLookOutLeft": 0.8, "eyeLookInRight": 0.8, "mouthSmileLeft": 0.5, "mouthSmileRight": 0.5}),
    (2.6, {"eyeLookInLeft": 0.8, "eyeLookOutRight": 0.8, "browInnerUpLeft": 0.8, "browInnerUpRight": 0.8}),
    (3.2, {"jawOpen": 0.7, "browOuterUpLeft": 0.6, "browOuterUpRight": 0.6}),
    (3.8, {}),
)


def demo_clip(rig: Rig) -> SceneAnimation:
    """A few seconds that show what a face can do, for :func:`avatar_scene`."""
    keys = np.array([seconds for seconds, _ in _CLIP])
    times = np.arange(round(keys[-1] * _FRAMES_PER_SECOND) + 1) / _FRAMES_PER_SECOND
    at_keys = np.array([[then.get(name, 0.0) for name, _ in own_shapes(rig)] for _, then in _CLIP])
    columns = [np.interp(times, keys, column) for column in at_keys.T]
    return SceneAnimation(times, {"head": np.column_stack(columns)}, name="demo")


def weight_clip(rig: Rig, times: object, weights: object, turns: object = None) -> SceneAnimation:
    """Weights over time, for :func:`avatar_scene`.

    Parameters
    ----------
    rig : Rig
    times : (f,) s, increasing, the first >= 0
    weights : (f, 46) or (f, 54)
        Of the rig's expressions, then of the ``eyeLook*`` names.
    turns : (f, 4), optional
        Unit quaternions x, y, z, w by which the head turns about its neck.

    Raises
    ------
    ValueError
        If they are not of these shapes, not finite, or beyond what float32 of the file can hold in play.
    """
    try:
        k, given, at = len(rig.names), np.asarray(weights, np.float64), np.asarray(times, np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"animation: expected times (f,) and weights (f, k), got no numbers ({error})") from None
    whole = k + len(GAZE_NAMES)
    if given.ndim != 2 or given.shape[1] not in (k, whole):
        raise ValueError(f"animation: expected weights (f, {k}) or (f, {whole}), got shape {given.shape}")
    if not (np.abs(given) <= _LARGEST_WEIGHT).all() or not (np.abs(at) <= _LONGEST_S).all():  # nor NaN
        raise ValueError(
            f"animation: expected finite weights up to {_LARGEST_WEIGHT:g} and times up to {_LONGEST_S:g} s"
        )
    given = np.pad(given, ((0, 0), (0, whole - given.shape[1])))
    turning = None if turns is None else np.asarray(turns, np.float64)
    neck = None if turns is None else NECK_MM
    return SceneAnimation(at, {"head": given}, name="take", turns=turning, neck=neck)
