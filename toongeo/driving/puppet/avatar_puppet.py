"""An avatar as it performs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.driving.head_turn import head_rotation
from toongeo.model.anatomy.neck import NECK_MM
from toongeo.pipeline.rig.animator import Animator

if TYPE_CHECKING:
    from toongeo.avatar.avatar import Avatar  # a second of imports, which a process that only draws does without

__all__ = ["AvatarPuppet"]


class AvatarPuppet:
    """Pictures of an avatar from the front as its weights change; what does not change is prepared once.

    Parameters
    ----------
    avatar : Avatar
    size : int
        Side of the pictures, px.
    """

    def __init__(self, avatar: Avatar, size: int = 512) -> None:
        self._animator = Animator(avatar, limits=None)
        self._renderer = avatar.frame_renderer(size)
        # Behind the head and its eyes come hair and the end of the neck, which move only with the head.
        self._still = self._renderer.rest[1 + len(avatar.eyes.templates) :]

    def frame(self, weights: ArrayLike, head: ArrayLike | None = None) -> NDArray[np.uint8]:
        """Picture (size, size, 3) RGB.

        Parameters
        ----------
        weights : (54,)
            Of the expressions and directions of gaze.
        head : (3,) radians, optional
            Yaw, pitch and roll, by which the head turns about the neck: see `head_rotation`.
        """
        row = np.asarray(weights, np.float64)
        parts = [self._animator.frame(row), *self._animator.eye_frames(row), *self._still]
        if head is not None:
            turn = head_rotation(head)
            parts = [(part - NECK_MM) @ turn.T + NECK_MM for part in parts]
        return self._renderer.frame(parts)
