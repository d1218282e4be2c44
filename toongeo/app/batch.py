"""``toongeo batch``: an avatar of each picture of a folder."""

import argparse
import sys
from pathlib import Path
from typing import Any

__all__ = ["add_batch"]


def add_batch(commands: Any) -> None:
    """The command's arguments."""
    batch = commands.add_parser("batch", help="turn all pictures of a folder into avatars")
    batch.add_argument("folder", type=Path, metavar="FOLDER", help="pictures, with landmarks beside them or without")
    batch.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help="folder of the avatars")
    batch.add_argument("--suffix", default=".glb", help="kind of file: .glb .vrm .html .usdz .obj .ply (default .glb)")
    batch.add_argument("--texture-size", type=int, default=1024, metavar="N", help="side of the atlas (default 1024)")
    batch.add_argument("--quantize", action="store_true", help=".glb of half the size, off by less than 0.1 mm")
    batch.add_argument("--snap", action="store_true", help="eye landmarks are a detector's: put them onto the lids")
    batch.add_argument("--no-hair", action="store_true", help="build no hair; it stays painted on the head")
    batch.add_argument("--accept", action="store_true", help="go on with landmarks that were found but are not sure")
    batch.add_argument("--scheme", default="auto", metavar="NAME", help="of the landmarks (default auto)")
    batch.add_argument("--backend", choices=("loky", "threading", "serial", "dask", "ray"), help="default loky")
    batch.add_argument("--workers", type=int, metavar="N", help="pictures at once (default: the cores)")
    batch.add_argument("--scheduler", metavar="ADDRESS", help="of a dask that runs, tcp://...")
    batch.add_argument("--resume", action="store_true", help="leave out what is done and unchanged")
    batch.add_argument("--seconds", type=float, default=300.0, metavar="S", help="a picture may take (default 300)")
    batch.add_argument("--memory", type=int, default=3000, metavar="MB", help="a picture may take (default 3000)")
    batch.set_defaults(run=_batch)


def _batch(options: argparse.Namespace) -> None:
    from toongeo.batch import BatchLimits, BatchOptions, make_avatars

    backend: Any = options.backend or ("dask" if options.scheduler else "loky")
    result = make_avatars(
        options.folder,
        options.output,
        options=BatchOptions(
            suffix=options.suffix,
            making={"texture_size": options.texture_size, "snap": options.snap, "hair": not options.no_hair},
            saving={"quantize": True} if options.quantize else {},
            scheme=options.scheme,
            accept=options.accept,
        ),
        limits=None if backend in ("threading", "serial") else BatchLimits(options.seconds, options.memory),
        backend=backend,
        workers=options.workers,
        scheduler=options.scheduler,
        resume=options.resume,
        progress=sys.stderr.isatty(),
    )
    counts = ", ".join(f"{count} {status}" for status, count in sorted(result.statuses.items()))
    print(f"{counts} ({result.skipped} from before)\nwrote {result.manifest} and {result.report}")
