"""Weights of a face that speaks."""

from __future__ import annotations

import os

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.speech.coarticulated import coarticulated
from toongeo.driving.speech.read_visemes import read_visemes
from toongeo.driving.speech.sounding_mouth import sounding_mouth
from toongeo.driving.speech.viseme_track import VisemeTrack
from toongeo.driving.take import MOST_FRAMES, Take
from toongeo.io import read_sound

__all__ = ["speak"]

_AFTER = 0.25  # s, in which the mouth comes to rest


def speak(
    visemes: VisemeTrack | str | os.PathLike[str] | None = None,
    *,
    sound: str | os.PathLike[str] | tuple[Floats, float] | None = None,
    fps: float = 60.0,
) -> Take:
    """A take of a mouth that speaks, from timings of visemes or from the sound alone.

    Visemes become weights that run into each other by dominance functions (Cohen and Massaro 1993). A sound alone gives
    a jaw and lips that move with loudness and formants: it goes with the speech, but no lip-reader could follow it.

    Parameters
    ----------
    visemes : VisemeTrack, or path
        A file as of :func:`toongeo.driving.read_visemes`: Rhubarb's, TalkingHead's or Azure's.
    sound : path, or samples (n,) and their rate in Hz
        Looked at only without visemes; with them it tells how long the take is at least.
    fps : float
        Frames a second of the take.

    Returns
    -------
    Take
        Eyes and brows do not move.

    Raises
    ------
    OSError, ValueError
        If a file cannot be read or is not what it should be, neither is given, or the rate is not positive.
    ImportError
        If the sound is no ``.wav`` and PyAV is not installed.

    Examples
    --------
    >>> from toongeo.driving import VisemeTrack
    >>> from toongeo.model.expression_schemes import EXPRESSIONS
    >>> take = speak(VisemeTrack(("aa", "PP"), np.array([0.0, 0.3]), np.array([0.3, 0.4])), fps=10)
    >>> jaw = take.weights[:, EXPRESSIONS.index("jawOpen")]
    >>> bool(jaw[1] > 0.5 > 0.1 > jaw[-1]), take.seconds
    (True, 0.6)
    """
    if visemes is None and sound is None:
        raise ValueError("visemes, sound: expected one of them, got neither")
    if not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
    samples, rate = (np.zeros(0), 1.0) if sound is None else sound if isinstance(sound, tuple) else read_sound(sound)
    length = len(samples) / rate
    if visemes is None:
        times = _times(length, fps)
        weights = sounding_mouth(np.asarray(samples, np.float64), rate, times)
    else:
        track = visemes if isinstance(visemes, VisemeTrack) else read_visemes(visemes)
        times = _times(max(length, track.seconds + _AFTER), fps)
        weights = coarticulated(track, times)
    return Take(times, weights)


def _times(seconds: float, fps: float) -> Floats:
    if not seconds * fps < MOST_FRAMES:
        raise ValueError(f"fps: expected at most {MOST_FRAMES} frames, got {seconds:.6g} s at {fps:g} frames a second")
    return np.arange(int(seconds * fps + 1e-6) + 1) / fps
