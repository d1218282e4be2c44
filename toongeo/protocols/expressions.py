"""Where expressions come from."""

from typing import Any, Protocol

import numpy as np

__all__ = ["ExpressionDriver", "LandmarkMapper"]


class ExpressionDriver(Protocol):
    """Reads a performance - landmarks, blend shapes of a phone, or pictures, by a network say - as weights.

    :func:`toongeo.testing.check_expression_driver` checks one.

    Examples
    --------
    >>> from toongeo.testing import check_expression_driver
    >>> class Loudness:
    ...     "Opens the jaw by the loudness of a voice."
    ...     names = ("jawOpen",)
    ...     def frames(self, recording, fps):
    ...         size = max(int(recording.rate / fps), 1)
    ...         pieces = np.array_split(np.abs(recording.samples), max(len(recording.samples) // size, 1))
    ...         loudness = np.array([piece.mean() for piece in pieces])
    ...         return np.clip(loudness / max(loudness.max(), 1e-9), 0, 1)[:, None]
    >>> from types import SimpleNamespace
    >>> tone = SimpleNamespace(rate=8000, samples=np.sin(np.arange(4000.0)))
    >>> check_expression_driver(Loudness(), tone)
    """

    @property
    def names(self) -> tuple[str, ...]:
        """Names (w,) of expressions of the rig and directions of gaze."""
        ...

    def frames(self, recording: Any, fps: float) -> np.ndarray:
        """Weights (f, w) of a recording with f frames, so many a second."""
        ...


class LandmarkMapper(Protocol):
    """Takes the landmarks of a caricature to a normal face and back; a pair of networks, say, or `PartMapper`.

    ``to_caricature(*to_normal(landmarks))`` gives the landmarks back. :func:`toongeo.testing.check_landmark_mapper`
    checks one; ``caricature_rig(..., mapper=...)`` uses it.

    Examples
    --------
    >>> from toongeo.testing import check_landmark_mapper
    >>> class Stretched:
    ...     "The normal face is the drawing, made as high as it is wide."
    ...     def to_normal(self, landmarks):
    ...         low, size = np.nanmin(landmarks, 0), np.ptp(landmarks[np.isfinite(landmarks).all(1)], axis=0)
    ...         scale = np.array([1.0, size[0] / size[1]])
    ...         whole = np.where(np.isfinite(landmarks), landmarks, low)
    ...         return (whole - low) * scale, (low, scale)
    ...     def to_caricature(self, normal, context):
    ...         low, scale = context
    ...         return normal / scale + low
    >>> check_landmark_mapper(Stretched())
    """

    def to_normal(self, landmarks: np.ndarray) -> tuple[np.ndarray, Any]:
        """F+: landmarks (68, 2) px of the normal face for those of a drawing, and what ``to_caricature`` needs.

        NaN rows are missing in the drawing; the normal face has all.
        """
        ...

    def to_caricature(self, normal: np.ndarray, context: Any) -> np.ndarray:
        """F-: landmarks (68, 2) px of the drawing when its normal face has these."""
        ...
