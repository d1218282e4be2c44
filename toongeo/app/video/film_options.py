"""How a film is drawn."""

from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from toongeo.app.video.actor_pictures import Actor, film_size
from toongeo.app.video.write_video import check_video

__all__ = ["FilmOptions"]

_MOST_PROCESSES = 61  # that Windows can wait for; each takes some 200 MB


@dataclass(frozen=True)
class FilmOptions:
    """Of the commands that write one.

    Attributes
    ----------
    size : int
        Side of the face's picture, px, even.
    fps : float
        Frames a second of a video, keys of an animation, lines of a table.
    start, end : float, optional
        s of the take, between which it is played.
    actor : {"beside", "corner"}, optional
        Whether the film of the actor is seen too.
    processes : int, optional
        That draw; as many as there are cores unless given.
    """

    size: int = 512
    fps: float = 30.0
    start: float | None = None
    end: float | None = None
    actor: Actor | None = None
    processes: int | None = None

    def check(self, output: Path) -> None:
        """Refuse, before the work, what could not be written."""
        if self.actor not in (None, *get_args(Actor)):
            raise ValueError(f"actor: expected {' or '.join(get_args(Actor))}, got {self.actor!r}")
        if self.processes is not None and not 1 <= self.processes <= _MOST_PROCESSES:
            raise ValueError(f"processes: expected 1 to {_MOST_PROCESSES}, got {self.processes}")
        check_video(output, film_size(self.size, self.actor), self.fps)
