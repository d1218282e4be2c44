"""A take on a face, as a video."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from toongeo.app.video.actor_pictures import film_size, with_actor
from toongeo.app.video.film_frames import film_frames
from toongeo.app.video.film_options import FilmOptions
from toongeo.app.video.sound import Sound
from toongeo.app.video.write_video import write_video
from toongeo.driving import AvatarPuppet, ScenePuppet, Take
from toongeo.io import Scene, Video

if TYPE_CHECKING:
    from toongeo.avatar.avatar import Avatar

__all__ = ["write_film"]


class _Puppet(Protocol):
    def frame(self, weights: Any, head: Any = None) -> NDArray[np.uint8]: ...


@dataclass(frozen=True)
class _Drawing:
    """Draws a frame by its number; travels to other processes."""

    puppet: _Puppet
    rows: list[Any]
    head: NDArray[np.float64] | None

    def __call__(self, number: int) -> NDArray[np.uint8]:
        return self.puppet.frame(self.rows[number], None if self.head is None else self.head[number])


def write_film(
    output: Path,
    face: Avatar | Scene,
    take: Take,
    options: FilmOptions,
    *,
    columns: Mapping[str, NDArray[np.float64]] | None = None,
    actor: Video | None = None,
    sound: Sound | None = None,
) -> None:
    """Draw a take, which has the rate of the film, and write it as :func:`write_video` does.

    Parameters
    ----------
    output : Path
    face : Avatar or Scene
    take : Take
    options : FilmOptions
    columns : target -> (f,), optional
        Weights of a scene's targets, in place of the take's.
    actor : Video, optional
        That is seen beside the face, if the options say so.
    sound : Sound, optional
    """
    puppet: _Puppet
    if isinstance(face, Scene):
        puppet, given = ScenePuppet(face, options.size), columns or {}
        rows: list[Any] = [{name: float(column[k]) for name, column in given.items()} for k in range(len(take.times))]
    else:
        puppet, rows = AvatarPuppet(face, options.size), list(take.weights)
    drawing = _Drawing(puppet, rows, take.head)
    frames: Iterator[np.ndarray] = film_frames(drawing, len(rows), processes=options.processes)
    if options.actor is not None and actor is not None:
        frames = with_actor(frames, actor, options.actor, fps=options.fps, start=options.start or 0.0)
    write_video(output, frames, film_size(options.size, options.actor), options.fps, len(rows), sound=sound)
