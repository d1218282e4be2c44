"""``toongeo speak``: a face that speaks, from timings of visemes or a sound."""

import sys
from dataclasses import replace
from pathlib import Path

from toongeo.app.commands.path_is import path_is
from toongeo.app.drive import check_performance, perform
from toongeo.app.video.film_options import FilmOptions
from toongeo.app.video.sound import Sound
from toongeo.app.video.write_video import VIDEO_SUFFIXES
from toongeo.driving import speak as speech
from toongeo.io import has_pyav, read_sound

__all__ = ["speak"]


def speak(
    avatar: Path,
    output: Path,
    *,
    visemes: Path | None = None,
    audio: Path | None = None,
    options: FilmOptions | None = None,
) -> None:
    """Let an avatar speak and write it down as :func:`toongeo.app.drive.drive` does.

    Parameters
    ----------
    avatar, output : Path
    visemes : Path, optional
        As of :func:`toongeo.driving.read_visemes`.
    audio : Path, optional
        The sound of a video; without visemes the mouth moves with it.
    options : FilmOptions, optional

    Raises
    ------
    OSError, ValueError, ImportError
        As of :func:`toongeo.driving.speak` and ``drive``.
    """
    options = FilmOptions() if options is None else options
    check_performance(avatar, output, options, {"visemes": visemes, "audio": audio})
    with path_is("audio"):
        heard = None if audio is None else read_sound(audio)
    with path_is("visemes"):
        take = speech(visemes, sound=heard, fps=max(60.0, options.fps))
    sound = None
    if audio is not None and output.suffix.lower() in VIDEO_SUFFIXES:
        if has_pyav():
            sound = Sound(audio, options.start or 0.0)
        else:
            print('note: the video is silent; PyAV adds the sound: pip install "toongeo[video]"', file=sys.stderr)
    if visemes is None:
        take = replace(take, notes=("the mouth moves with the sound alone: it is no lip-reading",))
    perform(avatar, output, take, options, sound=sound)
