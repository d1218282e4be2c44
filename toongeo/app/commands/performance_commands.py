"""The arguments of ``toongeo drive`` and ``toongeo speak``."""

import argparse
from pathlib import Path
from typing import Any

__all__ = ["add_performances"]

_OUTPUTS = ".mp4, .webm, .glb, or .csv of Live Link Face"


def add_performances(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add ``drive`` and ``speak`` to the commands of ``toongeo``."""
    drive = commands.add_parser("drive", help="play a performance on an avatar: a video, an animated GLB, or a table")
    drive.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb of toongeo make")
    source = drive.add_mutually_exclusive_group(required=True)
    source.add_argument("--weights", type=Path, metavar="TAKE", help="Live Link Face .csv, or .npy (frames, 52 or 54)")
    source.add_argument("--landmarks", type=Path, metavar="TAKE", help=".npy .csv .json .xml, the first frame neutral")
    source.add_argument("--video", type=Path, metavar="FILM", help="of an actor whose face is followed: .mp4, .mov ...")
    scheme = "of the landmarks, such as wflw98 (default auto: by their number)"
    drive.add_argument("--scheme", default="auto", metavar="NAME", help=scheme)
    drive.add_argument("--take-fps", type=float, help="of a take that does not say it")
    neutral = "second of the film at which the actor looks into the camera without expression (default: looked for)"
    drive.add_argument("--neutral", type=float, metavar="S", help=neutral)
    gaps = "what stands where a table has no numbers (default interpolate)"
    drive.add_argument("--gaps", choices=("interpolate", "hold"), default="interpolate", help=gaps)
    drive.add_argument("--actor", choices=("beside", "corner"), help="show the film of the actor too")
    drive.add_argument("--sound", type=Path, metavar="FILE", help="for a video (default: that of the film)")
    _add_film(drive)
    drive.set_defaults(run=_drive, also={"path": "AVATAR"})
    _add_speak(commands)


def _add_speak(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    speak = commands.add_parser("speak", help="let an avatar speak, by timings of visemes or a sound")
    speak.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb of toongeo make")
    about = "Rhubarb's .json or .tsv, TalkingHead's .json, or Azure's viseme events"
    speak.add_argument("--visemes", type=Path, metavar="FILE", help=about)
    about = "heard in a video; without visemes the mouth moves with it. .wav, or more with the extra video"
    speak.add_argument("--audio", type=Path, metavar="FILE", help=about)
    _add_film(speak)
    speak.set_defaults(run=_speak, also={"path": "AVATAR"})


def _add_film(command: argparse.ArgumentParser) -> None:
    command.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=_OUTPUTS)
    command.add_argument("--size", type=int, default=512, metavar="N", help="side of the video (default 512)")
    command.add_argument("--fps", type=float, default=30.0, help="of the output (default 30)")
    command.add_argument("--start", type=float, metavar="S", help="seconds of the take where the output begins")
    command.add_argument("--end", type=float, metavar="S", help="seconds of the take where it ends")
    command.add_argument("--processes", type=int, metavar="N", help="that draw (default: one a core)")


def _options(options: argparse.Namespace, **others: Any) -> Any:
    from toongeo.app.video.film_options import FilmOptions

    names = ("size", "fps", "start", "end", "processes")
    return FilmOptions(**{name: getattr(options, name) for name in names}, **others)


def _drive(options: argparse.Namespace) -> None:
    from toongeo.app.drive import drive
    from toongeo.app.read_take import TakeSource

    source = TakeSource(
        options.weights,
        options.landmarks,
        options.video,
        options.take_fps,
        options.scheme,
        options.gaps,
        options.neutral,
    )
    drive(options.avatar, options.output, source, _options(options, actor=options.actor), sound=options.sound)


def _speak(options: argparse.Namespace) -> None:
    from toongeo.app.speak import speak

    film = _options(options)
    speak(options.avatar, options.output, visemes=options.visemes, audio=options.audio, options=film)
