"""How noisy landmarks are, told by what a face leaves unexplained of them."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats

__all__ = ["FIRST_NOISE", "LEAST_NOISE", "doubt_of", "noise_of"]

FIRST_NOISE = 1e-3  # of the face's width: what is assumed before anything is known
LEAST_NOISE = 1e-5  # so that landmarks without noise are explained exactly
_UNKNOWNS = 40  # about as many of the 136 coordinates are explained by weights and pose, whatever they are


def noise_of(errors: Floats) -> float:
    """Standard deviation of a coordinate's noise from errors (f, 68, 2) of a sequence, in widths of the face.

    What the face explains badly changes slowly, noise does not: second differences in time show the noise alone. The
    median tells it although some frames jump.
    """
    if len(errors) < 3:
        return FIRST_NOISE
    jerk = np.abs(np.diff(errors, 2, axis=0))
    if not np.isfinite(jerk).any():
        return FIRST_NOISE
    normal = np.sqrt(6) * 0.6745  # of the median of |x - 2 y + z| for unit normal x, y, z
    explained = np.sqrt(1 - _UNKNOWNS / 136)  # part of the noise that weights and pose have taken up
    return max(float(np.nanmedian(jerk)) / normal / explained, LEAST_NOISE)


def doubt_of(errors: Floats, caution: float) -> float:
    """How far to mistrust landmarks with errors (f, 68, 2): what is unexplained is noise, or a face not quite known.

    By the `caution` more is assumed than there is.
    """
    unexplained = float(np.nanmedian(np.abs(errors))) / 0.6745 / np.sqrt(1 - _UNKNOWNS / 136)
    return max(caution * unexplained, LEAST_NOISE)
