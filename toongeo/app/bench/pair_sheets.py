"""``toongeo bench pairs``: blind pairs of faces for people to judge (Table 3 of Pan et al. 2024)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from toongeo.app.bench.bench_folder import bench_folder
from toongeo.app.bench.blind_sheets import blind_sheets, side_by_side
from toongeo.app.bench.face_crop import face_crop
from toongeo.app.bench.plain_avatar import plain_avatar
from toongeo.arrays import Bytes, Floats
from toongeo.avatar.avatar import Avatar
from toongeo.avatar.make_avatar import make_avatar
from toongeo.pipeline import adjust_coefficients, fit_3dmm

__all__ = ["BASELINES", "FITTED", "pair_sheets"]

BASELINES = ("coarse", "adjust")
FITTED = ("ours", "baseline")
_YAWS = (0.0, 40.0)


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
    pictures = bench_folder(folder)

    def sheet(which: int, ours_is_a: bool) -> Bytes:
        img, landmarks = pictures[which].read()
        try:
            rivals = _rivals(img, landmarks, against)
        except (ValueError, RuntimeError) as error:
            raise type(error)(f"{pictures[which].name}: {error}") from error
        a, b = (_views(avatar, tile) for avatar in (rivals if ours_is_a else rivals[::-1]))
        # No landmarks are drawn: they would tell the judges what was fitted.
        return side_by_side(face_crop(img, landmarks, tile).pixels, a, b)

    names = [picture.name for picture in pictures]
    return blind_sheets(names, sheet, output, sides=FITTED, seed=seed, about={"baseline": against})


def _rivals(img: Bytes, landmarks: Floats, against: str) -> tuple[Avatar, Avatar]:
    """Ours and the baseline, both from the landmarks alone, as `make_avatar` is by default."""
    ours = make_avatar(img, landmarks, hair=False)  # the rival has none either
    fit = fit_3dmm(img, landmarks)
    if against == "adjust":
        fit = adjust_coefficients(fit, landmarks, "identity+expression")
    return ours, plain_avatar(img, landmarks, fit, ours.parse)


def _views(avatar: Avatar, tile: int) -> Bytes:
    """From the front and turned; (tile, 2 * tile, 3)."""
    return np.hstack([avatar.render(size=tile, yaw=yaw) for yaw in _YAWS])
