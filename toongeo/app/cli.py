"""The command ``toongeo``."""

import argparse
import sys
from pathlib import Path

from toongeo import __version__
from toongeo.app.bench.commands import add_bench


def main(arguments: list[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments
        ``sys.argv[1:]`` unless given.

    Returns
    -------
    int
        0 if all went well; 2 on bad input or a failed fit, with one line on standard error that says what and where.
    """
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except (ValueError, OSError, RuntimeError) as error:
        print(f"toongeo: {error}", file=sys.stderr)
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="toongeo", description="One portrait and its 68 landmarks in, an animatable 3D face out."
    )
    parser.add_argument("--version", action="version", version=f"toongeo {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    make = commands.add_parser("make", help="turn a picture and its landmarks into an avatar")
    make.add_argument("image", type=Path, metavar="IMAGE")
    make.add_argument("--landmarks", type=Path, required=True, metavar="FILE", help=".pts, .npy, .csv or .txt")
    make.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=".glb, .obj or .ply")
    make.add_argument("--texture-size", type=int, default=1024, metavar="N", help="side of the atlas (default 1024)")
    make.add_argument("--crop", choices=("head", "bust", "face"), default="head", help="what to write (default head)")
    make.add_argument("--snap", action="store_true", help="eye landmarks are a detector's: put them onto the lids")
    make.add_argument("--photometric", action="store_true", help="refine the fit by the picture")
    make.set_defaults(run=_make)
    demo = commands.add_parser("demo", help="make an avatar of a bundled picture")
    demo.add_argument("-o", "--output", type=Path, default=Path("toongeo-demo"), metavar="FOLDER")
    demo.set_defaults(run=_demo)
    rig = commands.add_parser("rig", help="give a neutral head of any topology the expressions")
    rig.add_argument("mesh", type=Path, metavar="MESH", help=".obj, mouth closed and eyes open")
    rig.add_argument(
        "--landmarks",
        type=Path,
        required=True,
        metavar="FILE",
        help=".json: 68 entries in iBUG order, each a vertex (0-based), [x, y, z], or null",
    )
    rig.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=".glb, in the mesh's own frame")
    rig.add_argument("--texture", type=Path, metavar="IMAGE", help="picture for the mesh's texture coordinates")
    rig.set_defaults(run=_rig)
    add_bench(commands)
    return parser


# The commands import what they need when they run, so that `toongeo --help` answers at once.


def _make(options: argparse.Namespace) -> None:
    from toongeo.app.make import make

    make(
        options.image,
        options.landmarks,
        options.output,
        texture_size=options.texture_size,
        crop=options.crop,
        snap=options.snap,
        photometric=options.photometric,
    )


def _rig(options: argparse.Namespace) -> None:
    from toongeo.app.rig import rig

    rig(options.mesh, options.landmarks, options.output, texture=options.texture)


def _demo(options: argparse.Namespace) -> None:
    from toongeo.app.demo import demo

    demo(options.output)
