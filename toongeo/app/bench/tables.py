"""``toongeo bench table1``, ``table2`` and ``table4``: Pan et al.'s tables on a folder of pictures."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from toongeo.app.bench.bench_folder import BenchPicture, bench_folder
from toongeo.app.bench.bench_table import BenchTable
from toongeo.app.bench.eos_rival import EosRival
from toongeo.app.bench.method_errors import PHOTOMETRIC, method_errors
from toongeo.avatar.avatar import Avatar
from toongeo.avatar.make_avatar import STAGES, make_avatar
from toongeo.metrics.landmark_distance import TABLE_PARTS

__all__ = ["table1", "table2", "table4"]

_TIMED = tuple(stage for stage in STAGES if stage != "style")  # pictures are taken as they are

_ERRORS = {
    "mean landmark distance, px of a 224 x 224 crop": tuple(TABLE_PARTS),
    "mean |dr| + |dg| + |db|, levels of 0..255": (PHOTOMETRIC,),
}
# Tables 1 and 2 of the paper, in the order of the columns; the paper's total is the sum of the parts.
_PAPER_COARSE = np.array([98.33, 0.55, 11.40, 1.54, 16.14, 127.96, 3.27])
_PAPER_FINE = np.array([8.27, 0.23, 11.33, 1.50, 16.11, 37.44, 0.83])
_PAPER_TOTALS = {"adjust exp": 143.38, "adjust id+exp": 110.70, "fine": 37.44}
# Table 4 of the paper: its stage -> our stages, seconds.
_PAPER_STAGES = {
    "coarse": (("fit",), 1.46),
    "fine": (("parse", "align", "texture"), 20.02),
    "rigging": (("rig", "eyes"), 1.84),
}
_PAPER_FRAME_MS = 3.56
_FRAMES = 20  # animated per picture; the median counts


def table1(folder: Path, eos: Path | None = None) -> BenchTable:
    """Coarse and fine face, with the mean face and eos as rivals (Table 1 of Pan et al. 2024).

    Parameters
    ----------
    folder : Path
        Pictures with landmarks beside them.
    eos : Path, optional
        Folder of the models that eos ships; needs eos-py.

    Raises
    ------
    ValueError, OSError
        If the folder holds no pictures or lacks landmarks, or a picture cannot be used; says which.
    """
    table = _errors("Table 1: coarse and fine", folder, eos, adjusted=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        ours = table.mean("fine") / table.mean("coarse")
    return _with_notes(
        table,
        _ratios("fine / coarse, here", ours, table.columns),
        _ratios("fine / coarse, paper", _PAPER_FINE / _PAPER_COARSE, table.columns),
        "The paper's total is the sum of the parts, ours the mean of the 68 points. Anchors are what the fine face is "
        "made to meet: the ratios can be forced.",
    )


def table2(folder: Path, eos: Path | None = None) -> BenchTable:
    """Alignment by deformation against coefficients bent onto the landmarks (Table 2 of Pan et al. 2024).

    Parameters and errors are those of `table1`.
    """
    table = _errors("Table 2: adjusted coefficients and deformation", folder, eos, adjusted=True)
    total = table.columns.index("total")
    ours = {method: table.mean(method)[total] for method in _PAPER_TOTALS}
    return _with_notes(table, _against("here", ours), _against("paper", _PAPER_TOTALS))


def table4(folder: Path) -> BenchTable:
    """Seconds a stage (Table 4 of Pan et al. 2024), after one avatar that does not count.

    Errors are those of `table1`.
    """
    pictures = bench_folder(folder)
    frames: list[float] = []

    def timed(img: NDArray[np.uint8], landmarks: NDArray[np.float64]) -> dict[str, dict[str, float]]:
        avatar = make_avatar(img, landmarks, photometric=True)
        frames.append(_frame_ms(avatar))
        seconds = {stage: avatar.report.seconds[stage] for stage in _TIMED}
        return {"toongeo": seconds | {"total": sum(seconds.values())}}

    _each(pictures[:1], timed)  # loads the model and prepares what is kept for it
    frames.clear()
    values = _each(pictures, timed)
    panels = {"seconds": (*_TIMED, "total")}
    table = BenchTable("Table 4: seconds a stage", tuple(p.name for p in pictures), panels, values, decimals=3)
    means = dict(zip(table.columns, table.mean("toongeo"), strict=True))
    groups = [
        f"{name} ({' + '.join(stages)}) {sum(means[stage] for stage in stages):.2f} s, paper {seconds} s"
        for name, (stages, seconds) in _PAPER_STAGES.items()
    ]
    frame = f"an animated frame {np.mean(frames):.3f} ± {np.std(frames):.3f} ms, paper {_PAPER_FRAME_MS} ms"
    return _with_notes(table, *groups, frame)


def _errors(title: str, folder: Path, eos: Path | None, adjusted: bool) -> BenchTable:
    pictures, rival = bench_folder(folder), None if eos is None else EosRival(eos)
    values = _each(pictures, lambda img, points: method_errors(img, points, adjusted=adjusted, eos=rival))
    return BenchTable(title, tuple(picture.name for picture in pictures), _ERRORS, values)


def _each(
    pictures: list[BenchPicture],
    measure: Callable[[NDArray[np.uint8], NDArray[np.float64]], Mapping[str, Mapping[str, float]]],
) -> dict[str, NDArray[np.float64]]:
    """Method -> figures (pictures, columns); an error says which picture it is about."""
    rows: dict[str, list[list[float]]] = {}
    for picture in tqdm(pictures, unit="picture", leave=False):
        try:
            found = measure(*picture.read())
        except (ValueError, RuntimeError) as error:
            raise type(error)(f"{picture.name}: {error}") from error
        for method, figures in found.items():
            rows.setdefault(method, []).append(list(figures.values()))
    return {method: np.array(figures) for method, figures in rows.items()}


def _frame_ms(avatar: Avatar) -> float:
    weights, times = np.linspace(0, 0.5, len(avatar.names)), []
    for _ in range(_FRAMES):
        started = time.perf_counter()
        avatar.vertices(weights)
        times.append(1000 * (time.perf_counter() - started))
    return float(np.median(times))


def _ratios(name: str, ratios: NDArray[np.float64], columns: tuple[str, ...]) -> str:
    return f"{name}: " + ", ".join(f"{column} {ratio:.3f}" for column, ratio in zip(columns, ratios, strict=True))


def _against(name: str, totals: Mapping[str, float]) -> str:
    figures = ", ".join(f"{method} {total:.2f}" for method, total in totals.items())
    return f"total, {name}: {figures}; fine / adjust id+exp {totals['fine'] / totals['adjust id+exp']:.3f}"


def _with_notes(table: BenchTable, *notes: str) -> BenchTable:
    return replace(table, notes=notes)
