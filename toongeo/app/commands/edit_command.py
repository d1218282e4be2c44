"""The arguments of ``toongeo edit``."""

import argparse
import csv
from pathlib import Path

from toongeo._data_path import data_path
from toongeo.app.commands.number_types import weight
from toongeo.app.commands.picture_arguments import add_landmarks

__all__ = ["add_edit"]


def add_edit(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add ``edit`` to the commands of ``toongeo``."""
    about = "by default what is given is added to the expression that the picture shows; a negative weight takes of it"
    edit = commands.add_parser("edit", help="give the face of a picture another expression", description=about)
    edit.add_argument("image", type=Path, metavar="IMAGE")
    edit.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=".png, .jpg, .webp")
    for name, note in _presets():
        edit.add_argument(_flag(name), type=weight, metavar="W", dest=f"preset_{name}", help=f"{note} (1 is all of it)")
    names = "expressions by ARKit's or other known names, such as jawOpen=0.3 eyeBlinkLeft=1 AU12=0.5"
    edit.add_argument("--weights", type=_pair, nargs="+", action="extend", metavar="NAME=W", default=None, help=names)
    whole = "the weights are the whole expression: what the picture shows besides goes"
    edit.add_argument("--absolute", action="store_true", help=whole)
    add_landmarks(edit)
    edit.set_defaults(run=_edit)


def _presets() -> list[tuple[str, str]]:
    """Whole expressions and what they are; from their table itself, so that `toongeo --help` answers at once."""
    with open(data_path("data_templates/presets.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [(row["name"], row["note"]) for row in rows if row["weights"] and not row["name"].startswith("viseme_")]


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _pair(text: str) -> tuple[str, float]:
    name, sign, amount = text.partition("=")
    if not (name and sign):
        raise argparse.ArgumentTypeError(f"expected NAME=W such as jawOpen=0.3, got {text!r}")
    return name, weight(amount)


def _edit(options: argparse.Namespace) -> None:
    from toongeo.app.landmark_source import LandmarkSource
    from toongeo.app.pictures.edit import edit

    weights: dict[str, float] = {}
    given = ((name, getattr(options, f"preset_{name}")) for name, _ in _presets())
    for name, amount in (*((n, w) for n, w in given if w is not None), *(options.weights or ())):
        weights[name] = weights.get(name, 0.0) + amount
    source = LandmarkSource(options.landmarks, options.scheme, options.face, options.accept)
    edit(options.image, options.output, weights, source, absolute=options.absolute)
