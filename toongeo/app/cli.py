"""The command ``toongeo``."""

import argparse
import sys
from pathlib import Path
from typing import Any, Literal

from toongeo import __version__
from toongeo.app.batch import add_batch
from toongeo.app.bench.commands import add_bench
from toongeo.app.unsure_landmarks_error import UnsureLandmarksError

__all__ = ["main"]


_SCHEME = "of the landmarks, such as wflw98 (default auto: by their number)"


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
        sure, with one line on standard error that says what and where; 130 if it was interrupted.
    """
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except UnsureLandmarksError as error:
        print(f"toongeo: {error}", file=sys.stderr)
        return 3
    except (ValueError, OSError, RuntimeError, ImportError) as error:
        print(f"toongeo: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("toongeo: interrupted", file=sys.stderr)
        return 130
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="toongeo", description="One portrait in, an animatable 3D face out.")
    parser.add_argument("--version", action="version", version=f"toongeo {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    make = commands.add_parser("make", help="turn a picture into an avatar")
    make.add_argument("image", type=Path, metavar="IMAGE")
    _add_landmarks(make)
    make.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT", help=".glb, .vrm, .html, .usdz, .obj, .ply"
    )
    make.add_argument("--texture-size", type=int, default=1024, metavar="N", help="side of the atlas (default 1024)")
    make.add_argument("--crop", choices=("head", "bust", "face"), default="head", help="what to write (default head)")
    make.add_argument("--format", choices=("obj-sequence",), help="OUT is a folder of an .obj an expression")
    make.add_argument("--quantize", action="store_true", help=".glb of half the size, off by less than 0.1 mm")
    make.add_argument(
        "--names", choices=("toongeo", "arkit", "talkinghead"), help="of the expressions in the file (default toongeo)"
    )
    make.add_argument("--texture", choices=("png", "jpeg", "none"), help="picture in a .glb or .vrm (default png)")
    make.add_argument("--author", action="append", metavar="NAME", help="for the licence of a .vrm; may be repeated")
    noise = "of the landmarks, in outer-eye distances; 0: exact (default auto: smoothed where they are plainly noisy)"
    make.add_argument("--noise", type=_sigma, default="auto", metavar="SIGMA", help=noise)
    make.add_argument("--snap", action="store_true", help="eye landmarks are a detector's: put them onto the lids")
    make.add_argument("--photometric", action="store_true", help="refine the fit by the picture")
    hair = make.add_mutually_exclusive_group()
    hair.add_argument("--hair-mask", type=Path, metavar="FILE", help="picture of IMAGE's size, white where hair is")
    hair.add_argument("--no-hair", action="store_true", help="build no hair; it stays painted on the head")
    make.add_argument("--scheme", default="auto", metavar="NAME", help=_SCHEME)
    make.set_defaults(run=_make)
    demo = commands.add_parser("demo", help="make an avatar of a bundled picture")
    demo.add_argument("-o", "--output", type=Path, default=Path("toongeo-demo"), metavar="FOLDER")
    demo.set_defaults(run=_demo)
    add_batch(commands)
    _add_landmarks_editor(commands)
    _add_drive(commands)
    _add_serve(commands)
    view = commands.add_parser("view", help="show an avatar in the browser")
    view.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb")
    view.add_argument("--no-open", action="store_true", help="only print where the page is")
    view.set_defaults(run=_view)
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
    return parser


def _add_landmarks_editor(commands: Any) -> None:
    editor = commands.add_parser("landmarks", help="place and correct landmarks in the browser, on this computer only")
    editor.add_argument("path", type=Path, metavar="PATH", help="a picture, or a folder of pictures")
    editor.add_argument("--landmarks", type=Path, metavar="FILE", help="where to start (default: the file beside it)")
    which = "which face, in the file or, by size, in the picture (default 0)"
    editor.add_argument("--face", type=int, default=0, metavar="N", help=which)
    editor.add_argument("-o", "--output", type=Path, metavar="OUT", help=".pts, .json, .csv (default: beside it)")
    editor.add_argument("--port", type=int, default=0, metavar="N", help="default: a free one")
    editor.add_argument("--no-open", action="store_true", help="only print where the page is")
    editor.set_defaults(run=_landmarks)


def _add_landmarks(command: argparse.ArgumentParser) -> None:
    """Where the 68 points of a picture come from."""
    files = ".pts .npy .csv .txt .json .ljson .xml; found if not given"
    command.add_argument("--landmarks", type=Path, metavar="FILE", help=files)
    which = "which face, in the file or, by size, in the picture (default 0)"
    command.add_argument("--face", type=int, default=0, metavar="N", help=which)
    command.add_argument("--accept", action="store_true", help="go on with landmarks that were found but are not sure")


def _add_drive(commands: Any) -> None:
    drive = commands.add_parser("drive", help="play a performance on an avatar: a video, an animated GLB, or a table")
    drive.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb of toongeo make")
    source = drive.add_mutually_exclusive_group(required=True)
    source.add_argument("--weights", type=Path, metavar="TAKE", help="Live Link Face .csv, or .npy (frames, 52 or 54)")
    source.add_argument("--landmarks", type=Path, metavar="TAKE", help=".npy .csv .json .xml, the first frame neutral")
    source.add_argument("--video", type=Path, metavar="FILM", help="of an actor whose face is followed: .mp4, .mov ...")
    drive.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT", help=".mp4, .glb, or .csv of Live Link Face"
    )
    drive.add_argument("--size", type=int, default=512, metavar="N", help="side of the video (default 512)")
    drive.add_argument("--fps", type=float, default=30.0, help="of the output (default 30)")
    drive.add_argument("--scheme", default="auto", metavar="NAME", help=_SCHEME)
    drive.add_argument("--take-fps", type=float, help="of a take that does not say it")
    drive.set_defaults(run=_drive)


def _add_serve(commands: Any) -> None:
    serve = commands.add_parser("serve", help="show an avatar that moves while weights come, on this computer only")
    serve.add_argument("avatar", type=Path, metavar="AVATAR", help=".glb")
    source = serve.add_mutually_exclusive_group()
    source.add_argument("--weights", type=Path, metavar="TAKE", help="play this take: .csv or .npy as for drive")
    source.add_argument("--camera", metavar="N", help="follow the face before this camera, 0 for the first; or a film")
    serve.add_argument("--loop", action="store_true", help="play it again and again")
    serve.add_argument("--port", type=int, default=0, metavar="N", help="default: a free one")
    serve.add_argument("--no-open", action="store_true", help="only print the addresses")
    serve.set_defaults(run=_serve)


# The commands import what they need when they run, so that `toongeo --help` answers at once.


def _make(options: argparse.Namespace) -> None:
    from toongeo.app.landmark_source import LandmarkSource
    from toongeo.app.make import make

    make(
        options.image,
        options.output,
        LandmarkSource(options.landmarks, options.scheme, options.face, options.accept),
        texture_size=options.texture_size,
        crop=options.crop,
        noise=options.noise,
        snap=options.snap,
        photometric=options.photometric,
        hair=not options.no_hair,
        hair_mask=options.hair_mask,
        format=options.format,
        options=_saving(options),
    )


def _sigma(text: str) -> float | Literal["auto"]:
    return "auto" if text == "auto" else float(text)


def _saving(options: argparse.Namespace) -> dict[str, Any]:
    """Those of the options of Avatar.save that were given."""
    saving: dict[str, Any] = {}
    if options.quantize:
        saving["quantize"] = True
    if options.names:
        saving["names"] = options.names
    if options.texture:
        saving["texture"] = None if options.texture == "none" else options.texture
    if options.author:
        from toongeo.io import VrmMeta

        saving["meta"] = VrmMeta(authors=tuple(options.author))
    return saving


def _rig(options: argparse.Namespace) -> None:
    from toongeo.app.rig import rig

    rig(options.mesh, options.landmarks, options.output, texture=options.texture)


def _demo(options: argparse.Namespace) -> None:
    from toongeo.app.demo import demo

    demo(options.output)


def _landmarks(options: argparse.Namespace) -> None:
    from toongeo.app.editor.edit_landmarks import edit_landmarks

    edit_landmarks(
        options.path,
        landmarks=options.landmarks,
        output=options.output,
        face=options.face,
        port=options.port,
        show=not options.no_open,
    )


def _drive(options: argparse.Namespace) -> None:
    from toongeo.app.drive import drive
    from toongeo.app.read_take import TakeSource

    source = TakeSource(options.weights, options.landmarks, options.video, options.take_fps, options.scheme)
    drive(options.avatar, options.output, source, size=options.size, fps=options.fps)


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
