"""Figures of several methods on several pictures, as text and as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["BenchTable", "table_csv", "table_text"]


@dataclass(frozen=True, eq=False)
class BenchTable:
    """What a command of ``toongeo bench`` found.

    Attributes
    ----------
    title : str
    pictures : (n,) names
    panels : unit -> columns
        Columns that share a unit stand side by side, in text and chart.
    values : method -> (n, columns)
        NaN where a method has no such figure.
    decimals : int
    notes : lines beneath the table
    """

    title: str
    pictures: tuple[str, ...]
    panels: Mapping[str, tuple[str, ...]]
    values: Mapping[str, NDArray[np.float64]]
    decimals: int = 2
    notes: tuple[str, ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        return tuple(column for columns in self.panels.values() for column in columns)

    def mean(self, method: str) -> NDArray[np.float64]:
        """Mean over the pictures, (columns,); NaN where no picture has the figure."""
        return np.array([known.mean() if len(known) else np.nan for known in self._known(method)])

    def deviation(self, method: str) -> NDArray[np.float64]:
        """Sample standard deviation over the pictures, (columns,); NaN for fewer than two."""
        return np.array([known.std(ddof=1) if len(known) > 1 else np.nan for known in self._known(method)])

    def _known(self, method: str) -> list[NDArray[np.float64]]:
        return [column[np.isfinite(column)] for column in self.values[method].T]


def table_text(table: BenchTable) -> str:
    """Mean ± standard deviation of each method, in columns of equal width."""
    rows = [["", *table.columns]]
    for method in table.values:
        cells = zip(table.mean(method), table.deviation(method), strict=True)
        rows.append([method, *(_cell(mean, deviation, table.decimals) for mean, deviation in cells)])
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    # Names to the left, figures to the right.
    lines = ["  ".join([f"{row[0]:<{widths[0]}}", *map(str.rjust, row[1:], widths[1:])]) for row in rows]
    units = "; ".join(f"{', '.join(columns)}: {unit}" for unit, columns in table.panels.items())
    count = f"mean ± standard deviation over {len(table.pictures)} pictures"
    return "\n".join([table.title, "", *(line.rstrip() for line in lines), "", f"{count}; {units}", *table.notes])


def _cell(mean: float, deviation: float, decimals: int) -> str:
    if not np.isfinite(mean):
        return "-"
    spread = f" ± {deviation:.{decimals}f}" if np.isfinite(deviation) else ""
    return f"{mean:.{decimals}f}{spread}"


def table_csv(table: BenchTable) -> str:
    """A line for each picture and method, then mean and sd of each method; empty where there is no figure."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["picture", "method", *table.columns])
    for k, picture in enumerate(table.pictures):
        for method, values in table.values.items():
            writer.writerow([picture, method, *_exact(values[k])])
    for name, figures in (("mean", table.mean), ("sd", table.deviation)):
        for method in table.values:
            writer.writerow([name, method, *_exact(figures(method))])
    return stream.getvalue()


def _exact(values: NDArray[np.float64]) -> list[str]:
    return [repr(float(value)) if np.isfinite(value) else "" for value in values]
