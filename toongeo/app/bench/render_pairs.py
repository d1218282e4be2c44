"""``toongeo bench pairs OLD NEW``: blind pairs of what two versions, or two programs, made of the same inputs."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from toongeo.app.bench.blind_sheets import blind_sheets, side_by_side
from toongeo.arrays import Bytes
from toongeo.io import read_image
from toongeo.io.readers.picture_files import is_picture_file, pictures_in

__all__ = ["RENDERED", "render_pairs"]

RENDERED = ("new", "old")


def render_pairs(old: Path, new: Path, output: Path, *, seed: int = 0, inputs: Path | None = None) -> list[Path]:
    """Write a sheet for each picture that two folders have under one name, the key, and a form for the answers.

    A and B are the pictures as they are, in an order that only the key tells: the new one is A on half of the sheets.
    Pictures that are the same pixel by pixel are left out.

    Parameters
    ----------
    old, new : Path
        Folders of renders; the same names in both, each pair of one size.
    output : Path
        Made if it is not there.
    seed : int
        Of the shuffles; choose one that the judges do not know.
    inputs : Path, optional
        Folder of the pictures that the faces were made from, of the same stems; each stands on top of its sheet, as
        high as the renders.

    Returns
    -------
    list of Path
        The sheets.

    Raises
    ------
    ValueError
        If a folder holds no pictures or lacks one of the other, two of a name differ in size, all are the same, or the
        seed is none.
    OSError
        If a folder is missing, or the output holds sheets already or cannot be written.
    """
    before, after = _pictures(old, "old"), _pictures(new, "new")
    for name, there, folder in (("new", before.keys() - after.keys(), new), ("old", after.keys() - before.keys(), old)):
        if there:
            raise ValueError(f"{name}: expected a picture {min(there)} as in the other folder, got none in {folder}")
    differing = [name for name in before if _differ(before[name], after[name])]
    if not differing:
        raise ValueError(f"new: expected pictures that differ from those of {old}, got {len(before)} that are the same")
    shown = [None] * len(differing) if inputs is None else [_input(inputs, name) for name in differing]

    def sheet(which: int, new_is_a: bool) -> Bytes:
        a, b = (read_image(folder[differing[which]]) for folder in ((after, before) if new_is_a else (before, after)))
        path = shown[which]
        return side_by_side(None if path is None else _of_height(read_image(path), len(a)), a, b)

    about = {"old": old.name, "new": new.name}
    return blind_sheets(differing, sheet, output, sides=RENDERED, seed=seed, about=about)


def _pictures(folder: Path, argument: str) -> dict[str, Path]:
    if not folder.is_dir():
        raise NotADirectoryError(f"{argument}: expected a folder of pictures, got {folder}")
    return {path.name: path for path in pictures_in(folder, argument)}


def _differ(before: Path, after: Path) -> bool:
    a, b = read_image(before), read_image(after)
    if a.shape != b.shape:
        sizes = " and ".join(f"{x.shape[1]} x {x.shape[0]}" for x in (a, b))
        raise ValueError(f"new: expected two pictures {before.name} of one size, got {sizes} px")
    return bool((a != b).any())


def _input(folder: Path, name: str) -> Path:
    found = sorted(p for p in folder.glob(f"{Path(name).stem}.*") if is_picture_file(p))
    if not found:
        raise ValueError(f"inputs: expected a picture {Path(name).stem}, got none in {folder}")
    return found[0]


def _of_height(img: Bytes, height: int) -> Bytes:
    width = max(1, round(img.shape[1] * height / img.shape[0]))
    how = cv2.INTER_AREA if height < img.shape[0] else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(img, (width, height), interpolation=how), np.uint8)
