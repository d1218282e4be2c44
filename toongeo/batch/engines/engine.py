"""What a batch needs of a backend."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Protocol

__all__ = ["Engine"]


class Engine(Protocol):
    """Runs functions somewhere."""

    workers: int
    """How many at once."""

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin a call."""

    def restart(self) -> None:
        """Go on after a worker was lost, if that ended others too."""

    def close(self, *, now: bool) -> None:
        """End all workers; ``now``: whatever they are at."""
