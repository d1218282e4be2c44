"""Which viseme is spoken when."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.driving.speech.viseme_table import VISEMES

__all__ = ["VisemeTrack"]

_LONGEST = 6 * 3600.0  # s; beyond it the unit of the times is not what was thought


@dataclass(frozen=True, eq=False)
class VisemeTrack:
    """Visemes of Oculus with their times, in their order; they may overlap, and between them the mouth rests.

    Attributes
    ----------
    names : tuple of str
        Of ``sil PP FF TH DD kk CH SS nn RR aa E ih oh ou``.
    starts, ends : (k,) float64, s

    Raises
    ------
    ValueError
        If there is none, a name is unknown, or times are not finite, not in order, or last for hours.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.driving import VisemeTrack
    >>> VisemeTrack(("PP", "aa"), np.array([0.0, 0.1]), np.array([0.1, 0.3])).names
    ('PP', 'aa')
    """

    names: tuple[str, ...]
    starts: Floats
    ends: Floats

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        k = len(self.names)
        for name in self.names:
            if name not in VISEMES:
                raise ValueError(f"names: expected visemes {' '.join(VISEMES)}, got {name!r}")
        if k == 0 or np.shape(self.starts) != (k,) or np.shape(self.ends) != (k,):
            got = f"{k} names, {np.shape(self.starts)}, {np.shape(self.ends)}"
            raise ValueError(f"starts, ends: expected a time for each of one viseme or more, got {got}")
        starts, ends = np.asarray(self.starts, np.float64), np.asarray(self.ends, np.float64)
        if not (np.isfinite(starts).all() and np.isfinite(ends).all()):
            raise ValueError("starts, ends: expected finite seconds, got NaN or infinity")
        if starts.min() < 0 or (ends < starts).any() or (np.diff(starts) < 0).any():
            raise ValueError("starts, ends: expected seconds >= 0 that do not go back")
        if ends.max() > _LONGEST:
            raise ValueError(f"ends: expected seconds of some hours at most, got {ends.max():.0f}")
        read_only(self, "starts", "ends")

    @property
    def seconds(self) -> float:
        """When the last one ends."""
        return float(self.ends.max())
