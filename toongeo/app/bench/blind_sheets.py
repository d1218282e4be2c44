"""Sheets that show two rivals as A and B, the key that tells which is which, and a form for the answers."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from tqdm import tqdm

from toongeo.arrays import Bytes
from toongeo.io import atomic_write, encode_image

__all__ = ["KEY", "QUESTIONS", "blind_sheets", "side_by_side"]

QUESTIONS = {
    "aesthetics": "Which 3D face is more pleasing to look at?",
    "accuracy": "Of which are the overall shape and the place of each part of the face more correct?",
    "similarity": "Which looks more like the input?",
}
KEY, _ANSWERS = ".key.json", "answers.csv"
_INK, _PAPER, _GUTTER = (40, 40, 40), 255, 24


def blind_sheets(
    pictures: Sequence[str],
    sheet: Callable[[int, bool], Bytes],
    output: Path,
    *,
    sides: tuple[str, str],
    seed: int,
    about: dict[str, Any],
) -> list[Path]:
    """Write a sheet for each picture, ``pair-01.png`` and so on, the key, and the form.

    The first side is A on half of the sheets, which come in a shuffled order; both orders follow from the seed.

    Parameters
    ----------
    pictures : sequence of str
        Names for the key.
    sheet : function ``(picture, first_is_a) -> (h, w, 3) uint8``
    output : Path
        Made if it is not there.
    sides : (str, str)
        What the two rivals are called in the key.
    seed : int
    about
        What else the key should tell.

    Raises
    ------
    ValueError
        If the seed is negative.
    OSError
        If the output holds sheets, a key or answers already, which would be lost, or cannot be written.
    """
    if seed < 0:
        raise ValueError(f"seed: expected an integer >= 0, got {seed}")
    names = [f"pair-{k + 1:02d}" for k in range(len(pictures))]
    for path in (output / _ANSWERS, output / KEY, *(output / f"{name}.png" for name in names)):
        if path.exists():
            raise FileExistsError(f"output: {path} is there already; choose another folder or move it")
    rng = np.random.default_rng(seed)
    order, first_is_a = rng.permutation(len(pictures)), rng.permutation(len(pictures)) % 2 == 0
    sheets: dict[str | os.PathLike[str], bytes] = {}
    pairs: dict[str, dict[str, str]] = {}
    for name, which, first in zip(names, tqdm(order, unit="pair", leave=False), first_is_a, strict=True):
        sheets[output / f"{name}.png"] = encode_image(sheet(int(which), bool(first)))
        a, b = sides if first else sides[::-1]
        pairs[name] = {"picture": pictures[which], "A": a, "B": b}
    key = {**about, "sides": sides, "seed": seed, "pairs": pairs}
    output.mkdir(parents=True, exist_ok=True)
    atomic_write(
        {
            **sheets,
            output / KEY: (json.dumps(key, indent=1) + "\n").encode(),
            output / _ANSWERS: _form(names).encode(),
        }
    )
    return [Path(path) for path in sheets]


def side_by_side(top: Bytes | None, a: Bytes, b: Bytes) -> Bytes:
    """A and B beside each other with their letters, the input over their middle; (h, w, 3)."""
    gutter = np.full((len(a), _GUTTER, 3), _PAPER, np.uint8)
    faces = np.hstack([_lettered(a, "A"), gutter, _lettered(b, "B")])
    if top is None:
        return faces
    wide = np.full((len(top), max(faces.shape[1], top.shape[1]), 3), _PAPER, np.uint8)
    first = (wide.shape[1] - top.shape[1]) // 2
    wide[:, first : first + top.shape[1]] = top
    below = np.full((len(faces), wide.shape[1], 3), _PAPER, np.uint8)
    below[:, : faces.shape[1]] = faces
    return np.vstack([wide, below])


def _lettered(picture: Bytes, letter: str) -> Bytes:
    picture = np.ascontiguousarray(picture).copy()
    cv2.putText(picture, letter, (10, 34), cv2.FONT_HERSHEY_SIMPLEX, 1.1, _INK, 2, cv2.LINE_AA)
    return picture


def _form(names: list[str]) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["picture", "question", "answer"])
    writer.writerows([name, question, ""] for name in names for question in QUESTIONS)
    return stream.getvalue()
