"""Weights of spoken visemes that run into each other."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.speech.viseme_table import VISEMES
from toongeo.driving.speech.viseme_track import VisemeTrack
from toongeo.model.expression_schemes import EXPRESSIONS

__all__ = ["coarticulated"]

_CORE = 0.5  # of a segment, in its middle, in which its dominance is whole
_REST = 0.02  # dominance of the mouth at rest: it comes back within a quarter of a second after the last viseme
_FRAMES = 1024  # at once: an hour of speech needs little memory then
_REACH = 2.0  # s, in which every dominance has fallen below that of the mouth at rest
_JAW, _SEAL = EXPRESSIONS.index("jawOpen"), EXPRESSIONS.index("mouthClose")


def coarticulated(track: VisemeTrack, times: Floats) -> Floats:
    """Weights (f, 54) of the visemes at times (f,), by dominance functions (Cohen and Massaro 1993).

    ``F(t) = sum_s D_s(t) T_s / sum_s D_s(t)`` (their Eq. 4) with ``D_s = alpha_s exp(-|tau| / reach_s)`` (their Eq. 3
    with c = 1), T_s the weights of the viseme. Unlike theirs, tau is counted from the middle half of the segment, not
    from its centre, so that a long silence is silent to its ends; and one alpha goes for all parts of the face. Where
    lips must meet (PP), they are sealed however far the vowels around keep the jaw open.

    Parameters
    ----------
    track : VisemeTrack
    times : (f,) s

    Returns
    -------
    (f, 54) float64
        0 to 1.

    References
    ----------
    M. M. Cohen, D. W. Massaro: Modeling coarticulation in synthetic visual speech. Models and Techniques in Computer
    Animation, Springer 1993, pp. 139-156.
    """
    weights = np.zeros((len(times), len(EXPRESSIONS)))
    for first in range(0, len(times), _FRAMES):
        some = slice(first, first + _FRAMES)
        low, high = times[some].min() - _REACH, times[some].max() + _REACH
        near = np.flatnonzero((track.starts <= high) & (track.ends >= low))
        weights[some] = _mixed([track.names[k] for k in near], track.starts[near], track.ends[near], times[some])
    return np.clip(weights, 0, 1)


def _mixed(names: list[str], starts: Floats, ends: Floats, times: Floats) -> Floats:
    if not names:
        return np.zeros((len(times), len(EXPRESSIONS)))
    entries = [VISEMES[name] for name in names]
    shrink = (1 - _CORE) / 2 * (ends - starts)
    early = (starts + shrink)[:, None] - times
    late = times - (ends - shrink)[:, None]
    reach = np.array([[entry.before, entry.after] for entry in entries])
    away = np.maximum(early, 0) / reach[:, :1] + np.maximum(late, 0) / reach[:, 1:]
    dominance = np.array([[entry.strength] for entry in entries]) * np.exp(-away)  # (k, f)
    total = dominance.sum(axis=0) + _REST
    weights = dominance.T @ np.stack([entry.weights for entry in entries]) / total[:, None]
    meeting = dominance[[name == "PP" for name in names]].sum(axis=0) / total
    weights[:, _SEAL] = np.maximum(weights[:, _SEAL], meeting * weights[:, _JAW])
    return np.asarray(weights)
