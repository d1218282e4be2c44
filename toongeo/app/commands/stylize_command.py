"""The arguments of ``toongeo stylize``."""

import argparse
from pathlib import Path

from toongeo.app.commands.number_types import weight
from toongeo.app.commands.picture_arguments import add_landmarks, add_style

__all__ = ["add_stylize"]


def add_stylize(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add ``stylize`` to the commands of ``toongeo``."""
    command = commands.add_parser("stylize", help="draw the face of a photograph, as a toon, in ink ...")
    command.add_argument("image", type=Path, metavar="IMAGE")
    command.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=".png, .jpg, .webp")
    add_style(command, default="toon")
    strength = "of the warp, 0 to 2; below 1 the photograph shows through (default 1)"
    command.add_argument("--strength", type=weight, default=1.0, metavar="S", help=strength)
    add_landmarks(command)
    command.set_defaults(run=_stylize, also={"path": "--output"})


def _stylize(options: argparse.Namespace) -> None:
    from toongeo.app.landmark_source import LandmarkSource
    from toongeo.app.pictures.stylize_file import stylize_file

    source = LandmarkSource(options.landmarks, options.scheme, options.face, options.accept)
    stylize_file(options.image, options.output, source, style=options.style, strength=options.strength)
