"""The command ``toongeo``."""

import argparse
import sys
import traceback
from pathlib import Path
from typing import Any

from toongeo import __version__
from toongeo.app.batch import add_batch
from toongeo.app.bench.commands import add_bench
from toongeo.app.commands.completion import add_completion
from toongeo.app.commands.edit_command import add_edit
from toongeo.app.commands.flags import in_flags, know_flags
from toongeo.app.commands.make_command import add_make
from toongeo.app.commands.number_types import port
from toongeo.app.commands.performance_commands import add_performances
from toongeo.app.commands.stylize_command import add_stylize
from toongeo.app.models.commands import add_model
from toongeo.app.unsure_landmarks_error import UnsureLandmarksError

__all__ = ["main"]

_INTERRUPTED = 130  # what shells expect of a program that Ctrl+C ended


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments
        ``sys.argv[1:]`` unless given.

    Returns
    -------
    int
        0 if all went well; 2 on bad input, a failed fit or a missing extra, 3 if landmarks were found that are not
        sure, 1 if toongeo itself is wrong, with one line on standard error that says what and where; 130 after Ctrl+C.
        Tracebacks are shown with ``--debug`` alone.
    """
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except (Exception, KeyboardInterrupt) as error:
        if options.debug:
            traceback.print_exception(error)
        return _told(error, options)
    return 0


def _told(error: BaseException, options: argparse.Namespace) -> int:
    """Say what went wrong; the exit code."""
    if isinstance(error, KeyboardInterrupt):
        return _INTERRUPTED
    if isinstance(error, UnsureLandmarksError):
        code, line = 3, str(error)
    elif isinstance(error, ValueError | OSError | RuntimeError | ImportError):
        code, line = 2, in_flags(_words(error), options)
    else:
        code, line = 1, f"{type(error).__name__}: {error} (a fault of toongeo; --debug shows where)"
    print(f"toongeo: {line}", file=sys.stderr)
    return code


def _words(error: Exception) -> str:
    """What an error says, without its number."""
    if not isinstance(error, OSError) or error.strerror is None:
        return str(error)
    return error.strerror if error.filename is None else f"{error.filename}: {error.strerror}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="toongeo", description="One portrait in, an animatable 3D face out.")
    parser.add_argument("--version", action="version", version=f"toongeo {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    add_make(commands)
    add_edit(commands)
    add_stylize(commands)
    demo = commands.add_parser("demo", help="make an avatar of a bundled picture")
    demo.add_argument("-o", "--output", type=Path, default=Path("toongeo-demo"), metavar="FOLDER")
    demo.set_defaults(run=_demo)
    add_batch(commands)
    _add_landmarks_editor(commands)
    add_performances(commands)
    _add_serve(commands)
    view = commands.add_parser("view", help="show an avatar in the browser")
    view.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb")
    view.add_argument("--no-open", action="store_true", help="only print where the page is")
    view.set_defaults(run=_view, also={"path": "AVATAR"})
    rig = commands.add_parser("rig", help="give a neutral head of any topology the expressions")
    rig.add_argument("mesh", type=Path, metavar="MESH", help=".obj .ply .stl .off .glb, mouth closed and eyes open")
    rig.add_argument(
        "--landmarks",
        type=Path,
        required=True,
        metavar="FILE",
        help=".json: 68 entries in iBUG order, each a vertex (0-based), [x, y, z], or null; or .ljson .pp .txt .csv",
    )
    rig.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=".glb, in the mesh's own frame")
    rig.add_argument("--texture", type=Path, metavar="IMAGE", help="picture for the mesh's texture coordinates")
    rig.set_defaults(run=_rig)
    add_bench(commands)
    add_model(commands)
    add_completion(commands, parser)
    _add_debug(parser)
    know_flags(parser)
    return parser


def _add_debug(parser: argparse.ArgumentParser, default: Any = False) -> None:
    """``--debug`` before and after a command."""
    parser.add_argument("--debug", action="store_true", default=default, help="show tracebacks")
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                _add_debug(command, argparse.SUPPRESS)


def _add_landmarks_editor(commands: Any) -> None:
    editor = commands.add_parser("landmarks", help="place and correct landmarks in the browser, on this computer only")
    editor.add_argument("path", type=Path, metavar="PATH", help="a picture, a folder of pictures, or a mesh")
    editor.add_argument("--landmarks", type=Path, metavar="FILE", help="where to start (default: the file beside it)")
    which = "which face, in the file or, by size, in the picture (default 0)"
    editor.add_argument("--face", type=int, default=0, metavar="N", help=which)
    editor.add_argument(
        "-o", "--output", type=Path, metavar="OUT", help=".pts, .json, .csv; of a mesh .json, .txt (default: beside it)"
    )
    editor.add_argument("--port", type=port, default=0, metavar="N", help="default: a free one")
    editor.add_argument("--no-open", action="store_true", help="only print where the page is")
    editor.set_defaults(run=_landmarks)


def _add_serve(commands: Any) -> None:
    serve = commands.add_parser("serve", help="show an avatar that moves while weights come, on this computer only")
    serve.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb")
    source = serve.add_mutually_exclusive_group()
    source.add_argument("--weights", type=Path, metavar="TAKE", help="play this take: .csv or .npy as for drive")
    source.add_argument("--camera", metavar="N", help="follow the face before this camera, 0 for the first; or a film")
    serve.add_argument("--loop", action="store_true", help="play it again and again")
    serve.add_argument("--port", type=port, default=0, metavar="N", help="default: a free one")
    serve.add_argument("--no-open", action="store_true", help="only print the addresses")
    serve.set_defaults(run=_serve, also={"path": "AVATAR"})


_MODEL_SUFFIXES = (".npz", ".mat", ".h5", ".pkl", ".bin")

# The commands import what they need when they run, so that `toongeo --help` answers at once.


def _rig(options: argparse.Namespace) -> None:
    from toongeo.app.rig import rig

    rig(options.mesh, options.landmarks, options.output, texture=options.texture)


def _demo(options: argparse.Namespace) -> None:
    from toongeo.app.demo import demo

    demo(options.output)


def _landmarks(options: argparse.Namespace) -> None:
    from toongeo.app.editor.edit_landmarks import edit_landmarks
    from toongeo.app.picker.pick_landmarks import pick_landmarks
    from toongeo.io import MESH_SUFFIXES

    suffix = options.path.suffix.lower()
    if suffix in _MODEL_SUFFIXES:
        raise ValueError(
            f"path: expected a picture, a folder of pictures or a mesh, got {options.path}; "
            "for a model of faces: toongeo model pick"
        )
    if suffix in MESH_SUFFIXES:
        pick_landmarks(
            options.path,
            landmarks=options.landmarks,
            output=options.output,
            port=options.port,
            show=not options.no_open,
        )
        return
    edit_landmarks(
        options.path,
        landmarks=options.landmarks,
        output=options.output,
        face=options.face,
        port=options.port,
        show=not options.no_open,
    )


def _serve(options: argparse.Namespace) -> None:
    from toongeo.app.live.serve import serve

    serve(
        options.avatar,
        weights=options.weights,
        camera=options.camera,
        port=options.port,
        loop=options.loop,
        show=not options.no_open,
    )


def _view(options: argparse.Namespace) -> None:
    from toongeo.app.view import view

    view(options.avatar, show=not options.no_open)
