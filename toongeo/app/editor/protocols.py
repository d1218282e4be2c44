"""What an editing session needs from others, and what a server needs from a session."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

from toongeo.arrays import Bytes, Floats
from toongeo.protocols import LandmarkDetection

__all__ = ["Detector", "Pictures", "Session"]


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


class Session(Protocol):
    """What a page asks, and the answers."""

    @property
    def title(self) -> str:
        """Of the page."""
        ...

    @property
    def n_pictures(self) -> int:
        """How many pictures it can show."""
        ...

    def settings(self) -> dict[str, Any]:
        """What the page knows from the beginning."""
        ...

    def shown_picture(self, k: int) -> bytes:
        """A picture as JPEG."""
        ...

    def answer(self, question: str, message: dict[str, Any]) -> dict[str, Any]:
        """What a question asks, as JSON takes it; a ValueError or an OSError is told to the page."""
        ...
