import csv
import io

import numpy as np
import pytest

from toongeo.app.bench.bar_chart import COLOURS, GRID, INK, bar_chart
from toongeo.app.bench.bench_table import BenchTable, table_csv, table_text

VALUES = {"one": np.array([[1.0, 10.0], [3.0, 10.0]]), "two": np.array([[0.5, np.nan], [0.5, np.nan]])}


@pytest.fixture
def table():
    return BenchTable("Title", ("a.png", "b.png"), {"px": ("eyes",), "levels": ("colour",)}, VALUES, notes=("a note",))


def test_text_has_mean_and_deviation_of_each_method(table):
    lines = table_text(table).splitlines()
    assert lines[2].split() == ["eyes", "colour"]
    assert lines[3].split("  ")[0] == "one" and "2.00 ± 1.41" in lines[3] and "10.00 ± 0.00" in lines[3]
    assert "0.50 ± 0.00" in lines[4] and lines[4].endswith(" -")
    assert "over 2 pictures" in lines[6] and "eyes: px; colour: levels" in lines[6] and lines[-1] == "a note"
    assert len({line.index("±") for line in lines[3:5]}) == 1


def test_one_picture_has_no_deviation():
    text = table_text(BenchTable("T", ("a",), {"px": ("eyes",)}, {"one": np.array([[2.0]])}))
    assert "2.00" in text and "2.00 ±" not in text


def test_csv_holds_every_figure_exactly(table):
    rows = list(csv.DictReader(io.StringIO(table_csv(table))))
    assert [row["picture"] for row in rows] == ["a.png", "a.png", "b.png", "b.png", "mean", "mean", "sd", "sd"]
    found = {
        method: [[float(row[column] or "nan") for column in table.columns] for row in rows if row["method"] == method]
        for method in VALUES
    }
    for method, values in VALUES.items():
        np.testing.assert_array_equal(found[method][:2], values)
        np.testing.assert_array_equal(found[method][2:], [table.mean(method), table.deviation(method)])


def test_bars_are_as_high_as_their_values():
    heights = {}
    for value in (2.0, 5.0, 10.0):
        values = {"one": np.array([[value]]), "two": np.array([[10.0]])}
        chart = bar_chart(BenchTable("T", ("a",), {"px": ("eyes",)}, values))
        bars = (chart[88:] == COLOURS[0]).all(axis=2)
        heights[value] = bars.sum(axis=0).max()
        assert (chart == INK).all(axis=2).any() and (chart == GRID).all(axis=2).any()
    assert heights[10.0] == pytest.approx(2 * heights[5.0], abs=2) == pytest.approx(5 * heights[2.0], abs=4)
    assert heights[10.0] == pytest.approx(320, abs=2)


def test_the_chart_draws_what_has_no_figures_as_nothing(table):
    chart = bar_chart(table)
    assert chart.dtype == np.uint8 and chart.ndim == 3
    nothing = BenchTable("T", ("a",), {"px": ("eyes",)}, {"one": np.zeros((1, 1)), "two": np.zeros((1, 1))})
    assert bar_chart(nothing).shape[2] == 3
