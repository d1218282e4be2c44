"""A sound for a video."""

from dataclasses import dataclass
from pathlib import Path

__all__ = ["Sound"]


@dataclass(frozen=True)
class Sound:
    """The sound of a file, or a stretch of it.

    Attributes
    ----------
    path : Path
        A sound, or a video with one.
    start : float, s
        Where in it the video begins.
    seconds : float, optional
        How much of it is heard; all unless given.
    """

    path: Path
    start: float = 0.0
    seconds: float | None = None
