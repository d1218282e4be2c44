"""Files beside an output, which the user did not name: they bear a mark, and only marked ones are replaced."""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Iterable
from pathlib import Path

from toongeo.arrays import Bytes
from toongeo.io.encode_image import encode_image

__all__ = ["check_side_files", "marked_picture", "side_mark"]

_HEAD = 4096  # bytes that hold the mark: a name has at most 255 letters, of which each may take 6
_PNG_HEADER = 33  # bytes of a PNG's signature and first chunk, before which nothing may stand


def side_mark(owner: str) -> str:
    """What stands at the beginning of a file that is written along with an output of this name; one line of ASCII.

    Examples
    --------
    >>> side_mark("face.obj")
    'toongeo wrote this for "face.obj"'
    """
    return f"toongeo wrote this for {json.dumps(owner)}"


def marked_picture(img: Bytes, owner: str) -> bytes:
    """A PNG with the mark as its comment."""
    content = encode_image(img)
    chunk = b"tEXtComment\0" + side_mark(owner).encode()
    comment = struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return content[:_PNG_HEADER] + comment + content[_PNG_HEADER:]


def check_side_files(paths: Iterable[str | os.PathLike[str]], owner: str) -> None:
    """Refuse to replace a file that was not written for this output before.

    Parameters
    ----------
    paths
        Files that will be written along with the output.
    owner
        The output's name.

    Raises
    ------
    FileExistsError
        If one of them exists and does not bear the mark of this output; says which.
    """
    for path in map(Path, paths):
        # A folder of that name is refused when it is written to. A pipe must not be opened: it would wait.
        if not path.exists() or path.is_dir() or (path.is_file() and _bears(path, side_mark(owner))):
            continue
        raise FileExistsError(
            f"{path} is there already and was not written for {owner}; move it or choose another name"
        )


def _bears(path: Path, mark: str) -> bool:
    with path.open("rb") as stream:
        return mark.encode() in stream.read(_HEAD)
