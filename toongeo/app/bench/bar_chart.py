"""Bars of several methods, drawn with OpenCV."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.app.bench.bench_table import BenchTable

__all__ = ["bar_chart"]

INK, GRID, _PAPER = (40, 40, 40), (222, 222, 222), 255
# Colours that differ in brightness too, for those who do not tell them by hue.
COLOURS = ((170, 170, 170), (95, 95, 95), (86, 180, 233), (230, 159, 0), (204, 121, 167), (0, 114, 78))
_BAR, _GAP, _NARROWEST = 22, 26, 84  # px: a bar, between groups, a group with its name
_HEIGHT, _TOP, _BOTTOM, _LEFT, _BETWEEN = 320, 88, 46, 64, 84
_TICKS = 5
_FONT, _SIZE = cv2.FONT_HERSHEY_SIMPLEX, 0.45


def bar_chart(table: BenchTable) -> NDArray[np.uint8]:
    """Means as bars with whiskers of one standard deviation; a panel with its own scale for each unit.

    Returns
    -------
    (H, W, 3) uint8 RGB
    """
    methods = list(table.values)
    group = max(len(methods) * _BAR + _GAP, _NARROWEST)
    widths = [max(len(columns) * group, _text_width(unit)) for unit, columns in table.panels.items()]
    legend = _LEFT + sum(_text_width(f"{method}    ") + _BAR for method in methods)
    bars = _LEFT + sum(widths) + _BETWEEN * (len(widths) - 1) + _GAP
    width = max(bars, legend, _LEFT + _text_width(table.title) + _GAP)
    canvas = np.full((_TOP + _HEIGHT + _BOTTOM, width, 3), _PAPER, np.uint8)
    _write(canvas, table.title, _LEFT, 22)
    x = _LEFT
    for method, colour in zip(methods, _colours(len(methods)), strict=True):
        cv2.rectangle(canvas, (x, 34), (x + 14, 46), colour, -1)
        _write(canvas, method, x + 20, 45)
        x += _text_width(f"{method}    ") + _BAR
    left, first = _LEFT, 0
    for (unit, columns), wide in zip(table.panels.items(), widths, strict=True):
        which = slice(first, first + len(columns))
        _panel(canvas, table, unit, columns, which, (left, wide, group))
        left, first = left + wide + _BETWEEN, first + len(columns)
    return canvas


def _panel(
    canvas: NDArray[np.uint8],
    table: BenchTable,
    unit: str,
    columns: tuple[str, ...],
    which: slice,
    place: tuple[int, int, int],
) -> None:
    left, wide, group = place
    means = np.array([table.mean(method)[which] for method in table.values])
    spreads = np.nan_to_num([table.deviation(method)[which] for method in table.values])
    step = _round_step(float(np.nanmax(means + spreads, initial=0.0)) / _TICKS)
    base, px = _TOP + _HEIGHT, _HEIGHT / (step * _TICKS)
    _write(canvas, unit, left, _TOP - 14)
    for k in range(_TICKS + 1):
        y, label = round(base - k * step * px), f"{k * step:.4g}"
        cv2.line(canvas, (left, y), (left + wide, y), INK if k == 0 else GRID, 1)
        _write(canvas, label, left - 8 - _text_width(label), y + 5)
    for k, column in enumerate(columns):
        middle = left + k * group + group // 2
        _write(canvas, column, middle - _text_width(column) // 2, base + 22)
        for i, colour in enumerate(_colours(len(means))):
            if np.isfinite(means[i, k]):
                x = middle - len(means) * _BAR // 2 + i * _BAR
                _bar(canvas, x, base, means[i, k] * px, spreads[i, k] * px, colour)


def _bar(canvas: NDArray[np.uint8], x: int, base: int, mean: float, spread: float, colour: tuple[int, ...]) -> None:
    cv2.rectangle(canvas, (x + 2, round(base - mean)), (x + _BAR - 3, base), colour, -1)
    low, high, middle = round(base - max(mean - spread, 0)), round(base - mean - spread), x + _BAR // 2 - 1
    if spread > 0:
        cv2.line(canvas, (middle, low), (middle, high), INK, 1)
        cv2.line(canvas, (middle - 3, high), (middle + 3, high), INK, 1)


def _colours(count: int) -> list[tuple[int, int, int]]:
    """The last method is ours and has the last colour."""
    rivals = list(COLOURS[:-1])
    while len(rivals) < count - 1:  # the same again, each time half as strong
        rivals += [((255 + r) // 2, (255 + g) // 2, (255 + b) // 2) for r, g, b in rivals[-len(COLOURS) + 1 :]]
    return [*rivals[: count - 1], COLOURS[-1]]


def _round_step(least: float) -> float:
    """The smallest of 1, 2, 2.5, 5 times a power of ten that is not below; 1 if there is nothing to show."""
    if not least > 0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(least))
    return float(next(factor * power for factor in (1, 2, 2.5, 5, 10) if factor * power >= least * (1 - 1e-9)))


def _text_width(text: str) -> int:
    return int(cv2.getTextSize(text, _FONT, _SIZE, 1)[0][0])


def _write(canvas: NDArray[np.uint8], text: str, x: int, y: int) -> None:
    cv2.putText(canvas, text, (x, y), _FONT, _SIZE, INK, 1, cv2.LINE_AA)
