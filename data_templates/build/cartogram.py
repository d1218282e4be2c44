"""A smooth map of the plane that gives dense places more room (Gastner and Newman, PNAS 101 (2004)
7499-7504)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.fft import dctn, idctn
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator
from scipy.ndimage import gaussian_filter, map_coordinates
from source import Floats

_GRID = 256
_MARGIN = 0.35  # of the extent, on either side: far enough for the map to be free
_STEPS = 120


def cartogram(points: Floats, sites: Floats, density: Floats) -> Floats:
    """Move `points` (n, 2) so that areas become proportional to what `density` (k,) > 0, known at `sites` (k,
    2), says.

    The density diffuses until it is the same everywhere, and the points flow along; being a flow, the map
    folds nothing over. Input that is mirror symmetric about x = 0 gives such output.
    """
    half = np.abs(sites[:, 0]).max() * (1 + _MARGIN)
    low, high = sites[:, 1].min(), sites[:, 1].max()
    bottom = low - _MARGIN * (high - low)
    step = max(2 * half, high + _MARGIN * (high - low) - bottom) / _GRID
    bottom -= (_GRID * step - (high - low) * (1 + 2 * _MARGIN)) / 2

    def to_grid(p: Floats) -> Floats:
        return np.column_stack([(p[:, 1] - bottom) / step - 0.5, p[:, 0] / step + _GRID / 2 - 0.5])

    start = _density_grid(to_grid(sites), density)
    waves = dctn(start, type=2, norm="ortho")
    k = np.pi * np.arange(_GRID) / _GRID
    decay = k[:, None] ** 2 + k[None] ** 2
    # Short steps first: fine detail of the density is gone soon.
    times = np.r_[0.0, np.geomspace(0.05, 3.0 * (_GRID / np.pi) ** 2, _STEPS)]
    at = to_grid(points)
    for now, then in pairwise(times):
        middle = at + _velocity(waves, decay, now, at) * (then - now) / 2
        at = at + _velocity(waves, decay, (now + then) / 2, middle) * (then - now)
    return np.column_stack([(at[:, 1] + 0.5 - _GRID / 2) * step, (at[:, 0] + 0.5) * step + bottom])


def _density_grid(sites: Floats, density: Floats) -> Floats:
    rows, columns = np.indices((_GRID, _GRID))
    inside = LinearNDInterpolator(sites, density)(rows, columns)
    nearest = NearestNDInterpolator(sites, density)(rows, columns)
    # Around the island: no pull in either direction on the whole.
    out = np.where(np.isnan(inside), 0.5 * nearest + 0.5 * density.mean(), inside)
    out = gaussian_filter(out, 2.0, mode="nearest")
    return (out + out[:, ::-1]) / 2


def _velocity(waves: Floats, decay: Floats, time: float, at: Floats) -> Floats:
    density = idctn(waves * np.exp(-decay * time), type=2, norm="ortho")
    down, across = np.gradient(density)
    return np.column_stack([-map_coordinates(g / density, at.T, order=1, mode="nearest") for g in (down, across)])
