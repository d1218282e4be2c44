"""Arguments of all commands that take a face in a picture."""

import argparse
from pathlib import Path

__all__ = ["SCHEME", "add_landmarks", "add_model", "add_style"]

# Those of toongeo.pipeline.STYLES, by hand, so that `toongeo --help` answers at once.
_STYLES = ("toon", "chibi", "caricature", "ink", "painted")


SCHEME = "of the landmarks, such as wflw98 (default auto: by their number)"


def add_landmarks(command: argparse.ArgumentParser) -> None:
    """Where the 68 points of a picture come from."""
    files = ".pts .npy .csv .txt .json .ljson .xml; found if not given"
    command.add_argument("--landmarks", type=Path, metavar="FILE", help=files)
    which = "which face, in the file or, by size, in the picture (default 0)"
    command.add_argument("--face", type=int, default=0, metavar="N", help=which)
    command.add_argument("--accept", action="store_true", help="go on with landmarks that were found but are not sure")
    command.add_argument("--scheme", default="auto", metavar="NAME", help=SCHEME)


def add_model(command: argparse.ArgumentParser) -> None:
    """A morphable model from elsewhere."""
    models = "a morphable model, as toongeo model takes it: BFM, FLAME, ICT-FaceKit, eos ..."
    command.add_argument("--model", type=Path, metavar="PATH", help=models)


def add_style(command: argparse.ArgumentParser, default: str | None) -> None:
    """How a photograph is drawn."""
    about = "draw the photograph first, and make the head of the drawing" if default is None else "of the drawing"
    about += "" if default is None else f" (default {default})"
    command.add_argument("--style", choices=_STYLES, default=default, help=about)
