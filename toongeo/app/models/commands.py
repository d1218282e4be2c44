"""``toongeo model info|convert|check|render|pick``: models of others on the command line."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from toongeo.app.commands.number_types import port

__all__ = ["add_model"]


def add_model(commands: Any) -> None:
    """Add the command to those of ``toongeo``; what it needs is imported when it runs."""
    model = commands.add_parser("model", help="look at a face model: BFM, FLAME, ICT-FaceKit, eos ...")
    verbs = model.add_subparsers(required=True, metavar="VERB")
    for name, (run, text) in _VERBS.items():
        verb = verbs.add_parser(name, help=text)
        verb.add_argument("path", type=Path, metavar="PATH", help="a file or folder of a model")
        verb.add_argument("--format", metavar="NAME", help="of the model (default: told by its content)")
        verb.add_argument("--landmarks", type=Path, metavar="FILE", help="its 68 landmarks: .json .txt .npz .npy .pkl")
        verb.add_argument("--expression", type=Path, metavar="FILE", help="its expressions: Exp_Pca.bin, of eos .bin")
        verb.add_argument(
            "--cache", type=Path, metavar="NPZ", help="to keep what is read from the folder of ICT-FaceKit"
        )
        if name == "pick":
            verb.add_argument("-o", "--output", type=Path, metavar="OUT", help=".json, .txt (default: beside it)")
            verb.add_argument("--port", type=port, default=0, metavar="N", help="default: a free one")
            verb.add_argument("--no-open", action="store_true", help="only print where the page is")
        if name in ("convert", "render"):
            what = ".npz" if name == "convert" else ".png, .jpg"
            verb.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=what)
        if name == "convert":
            verb.add_argument("--contours", action="store_true", help="find contour lines, so that jaw points slide")
            verb.add_argument("--uv", action="store_true", help="lay the surface out as a texture")
            verb.add_argument("--rig", action="store_true", help="put its people on the template, with all that it has")
        verb.set_defaults(run=run)


def _loaded(options: argparse.Namespace) -> Any:
    from toongeo.model import load_model

    return load_model(
        options.path,
        format=options.format,
        landmarks=options.landmarks,
        expression=options.expression,
        cache=options.cache,
    )


def _info(options: argparse.Namespace) -> None:
    from toongeo.app.models.model_facts import model_facts
    from toongeo.model import model_format

    print(f"format: {options.format or model_format(options.path)}")
    print("\n".join(model_facts(_loaded(options))))


def _check(options: argparse.Namespace) -> None:
    from toongeo.app.models.model_faults import model_faults

    faults = model_faults(_loaded(options))
    print("\n".join(faults) if faults else "nothing found that is wrong")
    if faults:
        raise ValueError(f"{options.path}: {len(faults)} of its parts look wrong")


def _convert(options: argparse.Namespace) -> None:
    from toongeo.model import save_model

    _check_output(options, (".npz",))
    model = _loaded(options)
    model = model.with_rig_of() if options.rig else model
    model = model.with_contours() if options.contours else model
    save_model(model.with_uv() if options.uv else model, options.output)
    print(options.output)


def _check_output(options: argparse.Namespace, suffixes: tuple[str, ...]) -> None:
    """Refuse an output before the work."""
    from toongeo.app.check_output import check_output

    if options.output.suffix.lower() not in suffixes:
        raise ValueError(f"output: expected {' or '.join(suffixes)}, got {options.output.name}")
    check_output(options.output, {"path": options.path})


def _render(options: argparse.Namespace) -> None:
    from toongeo.app.models.model_sheet import model_sheet
    from toongeo.io import write_image

    _check_output(options, (".png", ".jpg"))
    write_image(options.output, model_sheet(_loaded(options)))
    print(options.output)


def _pick(options: argparse.Namespace) -> None:
    from toongeo.app.picker.pick_landmarks import pick_landmarks

    pick_landmarks(
        options.path,
        landmarks=options.landmarks,
        output=options.output,
        as_model=True,
        format=options.format,
        expression=options.expression,
        cache=options.cache,
        port=options.port,
        show=not options.no_open,
    )


_VERBS = {
    "info": (_info, "what it has, and what it lacks"),
    "check": (_check, "what looks wrong: sides, order of landmarks, size, holes (exit code 2)"),
    "convert": (_convert, "write it as an .npz of toongeo"),
    "render": (_render, "draw its mean, modes, expressions and landmarks on one sheet"),
    "pick": (_pick, "click its 68 landmarks in the browser, or those of a mesh"),
}
