"""Little smoothing where something moves, much where it rests."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats

__all__ = ["OneEuroFilter", "smoothed_both_ways"]


class OneEuroFilter:
    """First-order low-pass filter of points whose cutoff grows with their speed: ``f = f_min + beta |dx/dt|``.

    Speeds are measured in standard deviations of the noise, and count only above what noise alone would show, so that
    one setting serves every camera. A point follows when it moves itself, and when all points together move: that is
    seen earlier, since the noise of many points averages out.

    Parameters
    ----------
    noise : float > 0
        Standard deviation of a coordinate.
    least_cutoff : float, Hz
        ``f_min``, of what rests.
    speed_cutoff : float, Hz
        Of the speed itself.
    alone, together : (threshold in s.d./s, Hz per s.d./s)
        For the speed of a point, and for the root mean square speed of all.
    start : (k, d), optional
        Where the points have long been. Without it, the first samples are averaged, as there is no past.

    References
    ----------
    G. Casiez, N. Roussel, D. Vogel, "1 Euro filter: a simple speed-based low-pass filter for noisy input in
    interactive systems", CHI 2012, Eq. 1-6 there.

    Examples
    --------
    >>> smooth = OneEuroFilter(noise=1.0)
    >>> still = np.zeros((4, 2))
    >>> [float(smooth(still + x, x / 30)[0, 0]) for x in (0, 0)]
    [0.0, 0.0]
    """

    def __init__(
        self,
        noise: float,
        *,
        least_cutoff: float = 0.1,
        speed_cutoff: float = 1.0,
        alone: tuple[float, float] = (25.0, 0.1),
        together: tuple[float, float] = (8.0, 0.3),
        start: Floats | None = None,
    ) -> None:
        if not noise > 0:
            raise ValueError(f"noise: expected a standard deviation > 0, got {noise!r}")
        self.noise = noise
        self._cutoffs = least_cutoff, speed_cutoff
        self._alone, self._together = alone, together
        self._start = start
        self._count = 0
        self._time = 0.0
        self._raw = self._value = self._speed = np.zeros((0, 0))

    def __call__(self, points: Floats, time: float) -> Floats:
        """Smoothed points (k, d) at a time in s, later than the last; NaN rows are missing and keep their value."""
        if self._count == 0:
            self._raw, self._speed = points, np.zeros(points.shape)
            self._value = points if self._start is None else self._start
        elif time > self._time:
            self._advance(points, time - self._time)
        self._count, self._time = self._count + 1, time
        return self._value

    def _advance(self, points: Floats, step: float) -> None:
        least, speed_cutoff = self._cutoffs
        new = np.isnan(self._value) & ~np.isnan(points)
        value, raw = np.where(new, points, self._value), np.where(new, points, self._raw)
        seen = np.where(np.isnan(points), value, points)
        measured = np.where(np.isnan(points), 0.0, (points - raw) / step)
        self._speed = self._speed + _share(speed_cutoff, step) * (np.nan_to_num(measured) - self._speed)
        alone = np.sqrt((self._speed**2).mean(axis=1)) / self.noise
        together = np.sqrt((alone**2).mean())
        cutoff = least + self._alone[1] * np.maximum(0.0, alone - self._alone[0])
        cutoff = cutoff + self._together[1] * max(0.0, together - self._together[0])
        share = _share(cutoff, step)
        if self._start is None:
            share = np.maximum(share, 1.0 / (self._count + 1))
        self._value = value + share[:, None] * (seen - value)
        self._raw = np.where(np.isnan(points), raw, points)


def smoothed_both_ways(points: Floats, noise: float, fps: float) -> Floats:
    """Points (f, k, d) of a whole sequence without delay: the mean of a filter that runs forwards and one that runs
    backwards; each begins where the other ended."""

    def run(points: Floats, start: Floats | None) -> Floats:
        smooth = OneEuroFilter(noise, start=start)
        return np.array([smooth(there, i / fps) for i, there in enumerate(points)])

    forwards = run(points, None)
    backwards = run(points[::-1], forwards[-1])[::-1]
    return (run(points, backwards[0]) + backwards) / 2


def _share(cutoff: np.ndarray | float, step: float) -> np.ndarray:
    """Of the new sample: ``1 / (1 + tau / T)`` with ``tau = 1 / (2 pi f)``."""
    return np.asarray(1.0 / (1.0 + 1.0 / (2.0 * np.pi * np.asarray(cutoff) * step)))
