"""Weights from what ARKit measured."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats
from toongeo.driving.read_live_link import read_live_link, scheme_matrix
from toongeo.driving.table.unit_weights import LARGEST
from toongeo.driving.take import Take
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

__all__ = ["ArkitDriver"]


class ArkitDriver:
    """Reads the 52 blend shapes of ARKit, as an :class:`toongeo.ExpressionDriver`.

    Two of ARKit's shapes, ``browInnerUp`` and ``cheekPuff``, move both halves of ours.

    Parameters
    ----------
    columns : sequence of names, optional
        Of the columns of arrays; the 52 names of ARKit in its own order unless given.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.driving import ArkitDriver
    >>> driver = ArkitDriver(columns=["jawOpen", "browInnerUp"])
    >>> weights = driver.frames(np.array([[0.5, 1.0]]))
    >>> [driver.names[k] for k in np.flatnonzero(weights[0])]
    ['browInnerUpLeft', 'browInnerUpRight', 'jawOpen']
    """

    names = EXPRESSIONS

    def __init__(self, columns: tuple[str, ...] | list[str] | None = None) -> None:
        known = SCHEMES["arkit"]
        self.columns = tuple(known) if columns is None else tuple(columns)
        unknown = [name for name in self.columns if name not in known]
        if unknown or len(set(self.columns)) != len(self.columns):
            problem = f"unknown: {', '.join(map(str, unknown))}" if unknown else "a name twice"
            raise ValueError(f"columns: expected names of ARKit, each once, got {problem}")

    def frames(self, recording: ArrayLike | str | os.PathLike[str], fps: float = 60.0) -> Floats:
        """Weights (f, 54) of the expressions ``names``.

        Parameters
        ----------
        recording : (f, 52) array, a column a name of ``columns``; or the path of a Live Link Face CSV
        fps : float
            Not used here: nothing is smoothed.

        Raises
        ------
        OSError, ValueError
            As of `read_live_link`; if an array has another shape or numbers that are not finite.
        """
        return self.take(recording, fps).weights

    def take(self, recording: Any, fps: float | None = None) -> Take:
        """The same with its times: those of the file, or frames at a rate (default 60)."""
        if isinstance(recording, (str, os.PathLike)):
            return read_live_link(recording, fps=fps)
        try:
            frames = np.atleast_2d(np.asarray(recording, np.float64))
        except (TypeError, ValueError):
            raise ValueError(f"recording: expected numbers (f, {len(self.columns)})") from None
        if frames.ndim != 2 or frames.shape[1] != len(self.columns):
            raise ValueError(f"recording: expected (f, {len(self.columns)}) weights, got {frames.shape}")
        bad = np.argwhere(~np.isfinite(frames))
        if len(bad):
            frame, column = bad[0]
            got = f"{frames[frame, column]} for {self.columns[column]} in frame {frame}"
            raise ValueError(f"recording: expected finite weights, got {got}")
        most = np.abs(frames).max(initial=0.0)
        if most > LARGEST:
            raise ValueError(f"recording: expected weights of 0 to 1, got up to {most:.4g}; divide percent by 100")
        return Take.of_frames(frames @ scheme_matrix("arkit", self.columns), 60.0 if fps is None else fps)
