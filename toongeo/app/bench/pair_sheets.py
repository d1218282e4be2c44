"""``toongeo bench pairs``: blind pairs of faces for people to judge (Table 3 of Pan et al. 2024)."""

from __future__ import annotations

import csv
import io
import json
import os
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from toongeo.app.bench.bench_folder import bench_folder
from toongeo.app.bench.face_crop import face_crop
from toongeo.app.bench.plain_avatar import plain_avatar
from toongeo.avatar.avatar import Avatar
from toongeo.avatar.make_avatar import make_avatar
from toongeo.io import atomic_write, encode_image
from toongeo.pipeline import adjust_coefficients, fit_3dmm

__all__ = ["BASELINES", "KEY", "QUESTIONS", "pair_sheets"]

QUESTIONS = {
    "aesthetics": "Which 3D face is more pleasing to look at?",
    "accuracy": "Of which are the overall shape and the place of each part of the face more correct?",
    "similarity": "Which looks more like the input?",
}
BASELINES = ("coarse", "adjust")
KEY, _ANSWERS = ".key.json", "answers.csv"
_YAWS = (0.0, 40.0)
_INK, _PAPER, _GUTTER = (40, 40, 40), 255, 24


def pair_sheets(folder: Path, output: Path, *, seed: int = 0, against: str = "coarse", tile: int = 360) -> list[Path]:
    """Write a sheet for each picture, the key, and a form for the answers.

    Each sheet, ``pair-01.png`` and so on, has the input on top and two textured faces, A and B, beneath, from the front
    and turned by 40 degrees: ours and the baseline, in an order that only the key tells. Ours is A on half of the
    sheets. Sheets come in a shuffled order too, and both orders follow from the seed.

    Parameters
    ----------
    folder : Path
        Pictures with landmarks beside them.
    output : Path
        Made if it is not there.
    seed : int
        Of the shuffles; choose one that the judges do not know.
    against : {"coarse", "adjust"}
        The baseline: the coarse fit, or that with identity and expression bent onto the landmarks without a
        prior, which meets them at any price and is a weak rival to the eye.
    tile : int
        Side of one view, px.

    Returns
    -------
    list of Path
        The sheets.

    Raises
    ------
    ValueError
        If the folder holds no pictures or lacks landmarks, or the baseline or the seed is not one.
    OSError
        If the output holds sheets, a key or answers already, which would be lost, or cannot be written.
    """
    if against not in BASELINES:
        raise ValueError(f"against: expected one of {', '.join(BASELINES)}, got {against!r}")
    if seed < 0:
        raise ValueError(f"seed: expected an integer >= 0, got {seed}")
    pictures = bench_folder(folder)
    names = [f"pair-{k + 1:02d}" for k in range(len(pictures))]
    for path in (output / _ANSWERS, output / KEY, *(output / f"{name}.png" for name in names)):
        if path.exists():
            raise FileExistsError(f"output: {path} is there already; choose another folder or move it")
    rng = np.random.default_rng(seed)
    order, ours_first = rng.permutation(len(pictures)), rng.permutation(len(pictures)) % 2 == 0
    sheets: dict[str | os.PathLike[str], bytes] = {}
    pairs: dict[str, dict[str, str]] = {}
    for k, which in enumerate(tqdm(order, unit="pair", leave=False)):
        picture, name = pictures[which], names[k]
        img, landmarks = picture.read()
        try:
            ours, baseline = _rivals(img, landmarks, against)
        except (ValueError, RuntimeError) as error:
            raise type(error)(f"{picture.name}: {error}") from error
        pair = (ours, baseline) if ours_first[k] else (baseline, ours)
        sheets[output / f"{name}.png"] = encode_image(_sheet(img, landmarks, pair, tile))
        sides = ("ours", "baseline") if ours_first[k] else ("baseline", "ours")
        pairs[name] = {"picture": picture.name, "A": sides[0], "B": sides[1]}
    key = {"baseline": against, "seed": seed, "pairs": pairs}
    output.mkdir(parents=True, exist_ok=True)
    atomic_write(
        {
            **sheets,
            output / KEY: (json.dumps(key, indent=1) + "\n").encode(),
            output / _ANSWERS: _form(list(pairs)).encode(),
        }
    )
    return [Path(sheet) for sheet in sheets]


def _rivals(img: NDArray[np.uint8], landmarks: NDArray[np.float64], against: str) -> tuple[Avatar, Avatar]:
    """Ours and the baseline, both from the landmarks alone, as `make_avatar` is by default."""
    ours = make_avatar(img, landmarks)
    fit = fit_3dmm(img, landmarks)
    if against == "adjust":
        fit = adjust_coefficients(fit, landmarks, "identity+expression")
    return ours, plain_avatar(img, landmarks, fit, ours.parse)


def _sheet(
    img: NDArray[np.uint8], landmarks: NDArray[np.float64], pair: tuple[Avatar, Avatar], tile: int
) -> NDArray[np.uint8]:
    """Input over A and B; (2 * tile, 4 * tile + 24, 3)."""
    gutter = np.full((tile, _GUTTER, 3), _PAPER, np.uint8)
    left, right = (_views(avatar, letter, tile) for avatar, letter in zip(pair, "AB", strict=True))
    faces = np.hstack([left, gutter, right])
    top = np.full_like(faces, _PAPER)
    first = (faces.shape[1] - tile) // 2
    # No landmarks are drawn: they would tell the judges what was fitted.
    top[:, first : first + tile] = face_crop(img, landmarks, tile).pixels
    return np.vstack([top, faces])


def _views(avatar: Avatar, letter: str, tile: int) -> NDArray[np.uint8]:
    views = np.ascontiguousarray(np.hstack([avatar.render(size=tile, yaw=yaw) for yaw in _YAWS]))
    cv2.putText(views, letter, (10, 34), cv2.FONT_HERSHEY_SIMPLEX, 1.1, _INK, 2, cv2.LINE_AA)
    return views


def _form(names: list[str]) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["picture", "question", "answer"])
    writer.writerows([name, question, ""] for name in names for question in QUESTIONS)
    return stream.getvalue()
