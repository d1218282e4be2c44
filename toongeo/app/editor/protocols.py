"""What an editing session needs from others."""

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from toongeo.arrays import Bytes, Floats
from toongeo.protocols import LandmarkDetection

__all__ = ["Detector", "Pictures"]


Detector = Callable[[Bytes], LandmarkDetection | None]


class Pictures(Protocol):
    """Pictures by number, and the files of their landmarks."""

    def __len__(self) -> int:
        """How many there are."""
        ...

    def name(self, k: int) -> str:
        """What a picture is called."""
        ...

    def picture(self, k: int) -> Bytes:
        """Pixels (H, W, 3)."""
        ...

    def landmarks(self, k: int, img: Bytes) -> Floats | None:
        """(68, 2) px, NaN where missing, of a picture (H, W, 3); None if it has none yet."""
        ...

    def is_done(self, k: int) -> bool:
        """Whether it has landmarks."""
        ...

    def target(self, k: int, suffix: str | None = None) -> Path:
        """Where its landmarks are saved, in a format or in that which they have."""
        ...

    def would_replace(self, k: int, suffix: str) -> bool:
        """Whether saving would replace a file that was not written in this session."""
        ...

    def save(self, k: int, landmarks: Floats, suffix: str) -> Path:
        """Keep landmarks (68, 2) px, NaN where missing; where."""
        ...
