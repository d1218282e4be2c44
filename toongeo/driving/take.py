"""A performance: weights over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.model.expression_schemes import EXPRESSIONS

__all__ = ["MOST_FRAMES", "Take"]

_TICK = 1e-6  # s, of rounding
MOST_FRAMES = 10**6  # 4.6 hours at 60 frames a second, 0.4 GB


@dataclass(frozen=True, eq=False)
class Take:
    """Weights of the 46 expressions and the eight gaze directions, frame by frame.

    Attributes
    ----------
    times : (f,) float64, s
        From 0, increasing.
    weights : (f, 54) float64
        Columns as in ``toongeo.model.expression_schemes.EXPRESSIONS``.
    head : (f, 3) float64, radians, or None
        Yaw, pitch and roll of the head as the recording has them; they are taken for those of ARKit, see
        ``toongeo.driving.head_rotation``.
    notes : tuple of str
        What a reader filled or left out.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> weights = np.zeros((61, 54))
    >>> weights[:, 0] = np.linspace(0, 1, 61)
    >>> take = tg.Take.of_frames(weights, fps=30)
    >>> take.seconds
    2.0
    >>> take.between(0.5, 1.5).weights.shape, take.resampled(10).weights.shape
    ((31, 54), (21, 54))
    """

    times: Floats
    weights: Floats
    head: Floats | None = None
    notes: tuple[str, ...] = ()

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        f = len(self.times)
        if np.shape(self.weights) != (f, len(EXPRESSIONS)):
            raise ValueError(f"weights: expected ({f}, {len(EXPRESSIONS)}), got {np.shape(self.weights)}")
        if f == 0 or not np.isfinite(self.times).all() or (np.diff(self.times) <= 0).any():
            raise ValueError("times: expected at least one frame, at increasing seconds")
        if not np.isfinite(self.weights).all():
            raise ValueError("weights: expected finite numbers, got NaN or infinity")
        read_only(self, "times", "weights", "head")

    @classmethod
    def of_frames(cls, weights: Floats, fps: float) -> Take:
        """Frames (f, 54) at a steady rate."""
        if not (np.isfinite(fps) and fps > 0):
            raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
        return cls(np.arange(len(weights)) / fps, np.asarray(weights, np.float64))

    @property
    def seconds(self) -> float:
        """From the first frame to the last."""
        return float(self.times[-1] - self.times[0])

    def between(self, start: float | None = None, end: float | None = None) -> Take:
        """The frames from one time to another, s from the first frame, at times that begin at 0 again.

        Raises
        ------
        ValueError
            If there is no frame between them.
        """
        since = self.times - self.times[0]
        kept = (since >= (0.0 if start is None else start) - _TICK) & (
            since <= (np.inf if end is None else end) + _TICK
        )
        if not kept.any():
            length = f"the take is {self.seconds:.2f} s long"
            raise ValueError(f"start, end: expected a frame between {start} and {end} s, got none ({length})")
        times = self.times[kept]
        return Take(times - times[0], self.weights[kept], None if self.head is None else self.head[kept], self.notes)

    def resampled(self, fps: float) -> Take:
        """The same at a steady rate; linear in between."""
        if not (np.isfinite(fps) and fps > 0):
            raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
        if self.seconds * fps >= MOST_FRAMES:
            raise ValueError(
                f"fps: expected at most {MOST_FRAMES} frames, got {self.seconds:.6g} s at {fps:g} frames a second"
            )
        times = np.arange(int(self.seconds * fps + 1e-6) + 1) / fps

        def at(values: Floats) -> Floats:
            return np.column_stack([np.interp(times, self.times - self.times[0], column) for column in values.T])

        return Take(times, at(self.weights), None if self.head is None else at(self.head), self.notes)
