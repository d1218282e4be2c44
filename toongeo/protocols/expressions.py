"""Where expressions come from."""

from typing import Any, Protocol

import numpy as np

__all__ = ["ExpressionDriver", "LandmarkMapper"]


class ExpressionDriver(Protocol):
    """Reads a performance - landmarks, blend shapes of a phone, or pictures, by a network say - as weights."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names (w,) of expressions of the rig and directions of gaze."""
        ...

    def frames(self, recording: Any, fps: float) -> np.ndarray:
        """Weights (f, w) of a recording with f frames, so many a second."""
        ...


class LandmarkMapper(Protocol):
    """Takes the landmarks of a caricature to a normal face and back; a pair of networks, say, or `PartMapper`.

    ``to_caricature(*to_normal(landmarks))`` gives the landmarks back.
    """

    def to_normal(self, landmarks: np.ndarray) -> tuple[np.ndarray, Any]:
        """F+: landmarks (68, 2) px of the normal face for those of a drawing, and what ``to_caricature`` needs.

        NaN rows are missing in the drawing; the normal face has all.
        """
        ...

    def to_caricature(self, normal: np.ndarray, context: Any) -> np.ndarray:
        """F-: landmarks (68, 2) px of the drawing when its normal face has these."""
        ...
