"""How a mouth may have moved, from the sound of speech alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg
import scipy.ndimage
import scipy.signal

from toongeo.arrays import Floats
from toongeo.model.expression_schemes import EXPRESSIONS

__all__ = ["sounding_mouth"]

_RATE = 10_000  # Hz: two formants of every voice lie below half of it (Markel and Gray 1976)
_RATES = (1_000, 384_000)  # Hz: below, no formant is left; above, no recorder goes, and filters fill the memory
_BLOCK = 4096  # windows that are looked at at once: some 30 MB, however long the sound is
_WINDOW, _HOP = 0.025, 0.010  # s, as in most analyses of speech
_ORDER = 12  # two poles a kHz, and two for the source (Markel and Gray 1976)
_WIDEST = 400.0  # Hz: a resonance that is broader is no formant
_QUIET_DB, _LOUD_DB = -35.0, -12.0  # below the loudest: silent, and as open as a vowel is
_NOTHING = 1e-9  # of the sound: what rounding leaves of a constant
_VOICED = 0.35  # of the energy of a window, repeated after a period
_PERIODS = (1 / 400, 1 / 70)  # s, of voices
_NEUTRAL = (500.0, 1500.0)  # Hz: formants of a tube of 17.5 cm, to which a speaker's medians are scaled (Fant 1960)
_F1 = (300.0, 750.0)  # Hz: of close vowels and open ones (Peterson and Barney 1952)
_F2 = (900.0, 1400.0, 1700.0, 2300.0)  # Hz: rounded to here, not rounded, not spread, spread from here
_OPEN, _ROUND, _SPREAD = 0.6, 0.6, 0.35  # weights of the widest vowel, the roundest, the most spread
_SMOOTH = 0.030  # s, s.d.: lips move no faster than about 8 Hz


def sounding_mouth(samples: Floats, rate: float, times: Floats) -> Floats:
    """Weights (f, 54) at times (f,) s of a jaw and lips that go with a sound.

    Nobody can tell lips from sound alone, and this does not try: the jaw opens as loudness and the first formant say,
    lips are round where the second formant is low, spread where it is high, and close in pauses. Which consonant is
    spoken it does not know; lips do not meet for p, b and m unless the voice pauses. Formants are the resonances of a
    linear prediction (autocorrelation method). They are scaled towards those of a neutral tube by the square root of
    what the speaker's medians are off: half of that may be the speaker, half what is said.

    Parameters
    ----------
    samples : (n,)
        Of one channel, in any unit.
    rate : float, Hz
    times : (f,) s

    Returns
    -------
    (f, 54) float64
        0 to 1: ``jawOpen``, ``mouthFunnel``, ``mouthPucker``, ``mouthStretch*``. All 0 for silence.

    Raises
    ------
    ValueError
        If samples are not finite, or the rate is none of a recorder.

    References
    ----------
    J. D. Markel, A. H. Gray: Linear Prediction of Speech, Springer 1976.
    """
    sound = np.asarray(samples, np.float64)
    if sound.ndim != 1 or not np.isfinite(sound).all():
        raise ValueError(f"samples: expected finite numbers (n,), got shape {sound.shape}")
    if not _RATES[0] <= rate <= _RATES[1]:
        raise ValueError(f"rate: expected {_RATES[0]} to {_RATES[1]} Hz, got {rate!r}")
    weights = np.zeros((len(times), len(EXPRESSIONS)))
    sound = _resampled(sound - sound.mean() if len(sound) else sound, rate)
    windows = _windows(sound)
    level = _in_blocks(lambda some: np.sqrt((some**2).mean(axis=1)), windows)
    if not level.max(initial=0.0) > _NOTHING * np.abs(samples).max(initial=0.0):
        return weights
    loud = np.clip((20 * np.log10(np.maximum(level / level.max(), 1e-9)) - _QUIET_DB) / (_LOUD_DB - _QUIET_DB), 0, 1)
    first, second = _formants(windows, _in_blocks(_voiced, windows) & (loud > 0))
    opened = loud * np.clip((first - _F1[0]) / (_F1[1] - _F1[0]), 0.15, 1)
    rounded = loud * np.clip((_F2[1] - second) / (_F2[1] - _F2[0]), 0, 1)
    spread = loud * np.clip((second - _F2[2]) / (_F2[3] - _F2[2]), 0, 1)
    at = _WINDOW / 2 + _HOP * np.arange(len(windows))
    for name, amount, most in (
        ("jawOpen", opened, _OPEN),
        ("mouthFunnel", rounded, 0.5 * _ROUND),
        ("mouthPucker", rounded, _ROUND),
        ("mouthStretchLeft", spread, _SPREAD),
        ("mouthStretchRight", spread, _SPREAD),
    ):
        smooth = scipy.ndimage.gaussian_filter1d(amount, _SMOOTH / _HOP, mode="constant")
        weights[:, EXPRESSIONS.index(name)] = most * np.interp(times, at, smooth, left=0.0, right=0.0)
    return weights


def _resampled(sound: Floats, rate: float) -> Floats:
    common = np.gcd(round(rate), _RATE)
    return (
        np.asarray(scipy.signal.resample_poly(sound, _RATE // common, round(rate) // common)) if len(sound) else sound
    )


def _windows(sound: Floats) -> Floats:
    """(w, n), half a window of silence before and after."""
    width, hop = round(_WINDOW * _RATE), round(_HOP * _RATE)
    padded = np.pad(sound, (0, max(0, width - len(sound)) + hop))
    return np.lib.stride_tricks.sliding_window_view(padded, width)[::hop]


def _in_blocks(of: Callable[[Floats], np.ndarray], windows: Floats) -> np.ndarray:
    return np.concatenate([of(windows[k : k + _BLOCK]) for k in range(0, len(windows), _BLOCK)])


def _voiced(windows: Floats) -> np.ndarray:
    """Whether each window repeats after a period of a voice."""
    size = 2 * windows.shape[1]
    power = np.abs(np.fft.rfft(windows * np.hanning(windows.shape[1]), size)) ** 2
    lags = np.fft.irfft(power, size)
    low, high = (round(period * _RATE) for period in _PERIODS)
    return np.asarray(lags[:, low:high].max(axis=1) > _VOICED * np.maximum(lags[:, 0], np.finfo(float).tiny))


def _formants(windows: Floats, voiced: np.ndarray) -> tuple[Floats, Floats]:
    """First and second formant (w,), Hz, of a neutral tract; where there is no voice, those of voices around."""
    found = np.full((len(windows), 2), np.nan)
    taper = np.hamming(windows.shape[1])
    for k in np.flatnonzero(voiced):
        resonances = _resonances(np.diff(windows[k], prepend=0.0) * taper)  # the lips' own slope is undone
        if len(resonances) >= 2:
            found[k] = resonances[:2]
    known = np.isfinite(found[:, 0])
    if not known.any():
        return np.full(len(windows), _NEUTRAL[0]), np.full(len(windows), _NEUTRAL[1])
    found = found * (np.array(_NEUTRAL) / np.median(found[known], axis=0)) ** 0.5
    filled = [np.interp(np.arange(len(found)), np.flatnonzero(known), column[known]) for column in found.T]
    first, second = (scipy.signal.medfilt(column, 5) for column in filled)
    return first, second


def _resonances(window: Floats) -> Floats:
    """Frequencies, Hz, of the narrow resonances of a window, the lowest first."""
    lags = np.correlate(window, window, "full")[len(window) - 1 :][: _ORDER + 1]
    if not lags[0] > 0:
        return np.zeros(0)
    lags[0] *= 1 + 1e-9  # a pure tone leaves nothing to predict
    coefficients = scipy.linalg.solve_toeplitz(lags[:-1], lags[1:])
    roots = np.roots(np.r_[1.0, -coefficients])
    roots = roots[roots.imag > 0]
    frequency = np.angle(roots) * _RATE / (2 * np.pi)
    width = -np.log(np.maximum(np.abs(roots), 1e-12)) * _RATE / np.pi
    return np.sort(frequency[(width < _WIDEST) & (frequency > 150) & (frequency < _RATE / 2 - 300)])
