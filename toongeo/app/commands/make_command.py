"""The arguments of ``toongeo make``."""

import argparse
from pathlib import Path
from typing import Any

from toongeo.app.commands.number_types import sigma
from toongeo.app.commands.picture_arguments import add_landmarks, add_model, add_style

__all__ = ["add_make"]


def add_make(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add ``make`` to the commands of ``toongeo``."""
    make = commands.add_parser("make", help="turn pictures into avatars")
    images = "a picture; several, or folders of them, become a head each"
    make.add_argument("image", type=Path, nargs="+", metavar="IMAGE", help=images)
    add_landmarks(make)
    outputs = ".glb, .vrm, .html, .usdz, .obj, .ply; for several pictures a folder, or 'heads/{name}.vrm'"
    make.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=outputs)
    sheet = "contact sheet too: .png or .jpg; for several pictures a folder, or '{name}.png'"
    make.add_argument("--sheet", type=Path, metavar="OUT", help=sheet)
    one = "the pictures show one person: one identity is fitted to all"
    make.add_argument("--same-person", action="store_true", help=one)
    make.add_argument("--json", action="store_true", help="print the report as JSON; a list for several pictures")
    _add_making(make)
    _add_saving(make)
    make.set_defaults(run=_make, also={"meta": "--author", "size": "--texture-size"})


def _add_making(make: argparse.ArgumentParser) -> None:
    add_model(make)
    methods = "how the face comes to its landmarks (default cartoon; caricature extrapolates exaggerated faces)"
    make.add_argument("--method", choices=("cartoon", "caricature"), default="cartoon", help=methods)
    rigs = "whose expressions it has: the template's, transferred (default), or its own, from exaggerated landmarks"
    make.add_argument("--rig", choices=("transfer", "caricature"), default="transfer", help=rigs)
    noise = "of the landmarks, in outer-eye distances; 0: exact (default auto: smoothed where they are plainly noisy)"
    make.add_argument("--noise", type=sigma, default="auto", metavar="SIGMA", help=noise)
    make.add_argument("--snap", action="store_true", help="eye landmarks are a detector's: put them onto the lids")
    refine = "refine the fit by the picture (default: in photographs of people)"
    make.add_argument("--photometric", action=argparse.BooleanOptionalAction, default="auto", help=refine)
    hair = make.add_mutually_exclusive_group()
    hair.add_argument("--hair-mask", type=Path, metavar="FILE", help="picture of IMAGE's size, white where hair is")
    hair.add_argument("--no-hair", action="store_true", help="build no hair; it stays painted on the head")
    add_style(make, default=None)
    make.add_argument("--texture-size", type=int, default=1024, metavar="N", help="side of the atlas (default 1024)")


def _add_saving(make: argparse.ArgumentParser) -> None:
    make.add_argument("--crop", choices=("head", "bust", "face"), default="head", help="what to write (default head)")
    make.add_argument("--format", choices=("obj-sequence",), help="OUT is a folder of an .obj an expression")
    make.add_argument("--quantize", action="store_true", help=".glb of half the size, off by less than 0.1 mm")
    make.add_argument(
        "--names", choices=("toongeo", "arkit", "talkinghead"), help="of the expressions in the file (default toongeo)"
    )
    make.add_argument("--texture", choices=("png", "jpeg", "none"), help="picture in a .glb or .vrm (default png)")
    unlit = "colours as they are drawn, without light, in a .glb or .vrm (default: of drawings)"
    make.add_argument("--unlit", action=argparse.BooleanOptionalAction, help=unlit)
    make.add_argument("--author", action="append", metavar="NAME", help="for the licence of a .vrm; may be repeated")


# What a command needs is imported when it runs, so that `toongeo --help` answers at once.


def _make(options: argparse.Namespace) -> None:
    from toongeo.app.landmark_source import LandmarkSource
    from toongeo.app.making.head_jobs import check_jobs, head_jobs
    from toongeo.app.making.make_heads import make_heads
    from toongeo.app.making.make_options import MakeOptions

    making = MakeOptions(
        model=None if options.model is None else _model(options.model),
        noise=options.noise,
        snap=options.snap,
        photometric=options.photometric,
        method=options.method,
        rig=options.rig,
        hair=not options.no_hair,
        hair_mask=options.hair_mask,
        style=options.style,
        texture_size=options.texture_size,
        format=options.format,
        saving=_saving(options),
        json=options.json,
    )
    source = LandmarkSource(None, options.scheme, options.face, options.accept)
    suffix = ".glb" if options.format is None else ""
    jobs = head_jobs(options.image, options.output, options.landmarks, options.sheet, suffix=suffix)
    check_jobs(jobs, making, one=options.same_person)
    make_heads(jobs, source, making, one=options.same_person)


def _model(path: Path) -> Any:
    from toongeo.model import load_model

    try:
        return load_model(path)
    except ValueError as error:  # of its own landmarks, say, which are not those of --landmarks
        raise ValueError(f"model: {str(error).removeprefix('path: ')}") from error


def _saving(options: argparse.Namespace) -> dict[str, Any]:
    """Those of the options of Avatar.save that were given."""
    saving: dict[str, Any] = {"crop": options.crop}
    if options.quantize:
        saving["quantize"] = True
    if options.names:
        saving["names"] = options.names
    if options.texture:
        saving["texture"] = None if options.texture == "none" else options.texture
    if options.unlit is not None:
        saving["unlit"] = options.unlit
    if options.author:
        from toongeo.io import VrmMeta

        saving["meta"] = VrmMeta(authors=tuple(options.author))
    return saving
