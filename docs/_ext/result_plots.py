"""Plots of the tables of ``benchmarks/RESULTS.md``, and of the ratios over commits, drawn when the site is built."""

import re
from dataclasses import dataclass

from ratio_plot import draw_ratios, ratio_runs, told_ratios
from repository_links import DOCS, ROOT

__all__ = ["CHARTS", "drawn_charts", "result_plots", "setup"]

_RESULTS = ROOT / "benchmarks" / "RESULTS.md"
_HISTORY = ROOT / "benchmarks" / "ratio_history.csv"
_PLOTS = DOCS / "_static" / "plots"
_PAGE = DOCS / "project" / "plots.md"
_INK = {"light": "#222832", "dark": "#ced6dd"}  # text of the theme on its ground
_BARS = {"light": ("#0a7d91", "#b35900"), "dark": ("#4fc3d9", "#f0a35e")}


_OVER_COMMITS = """## Over commits

How many times as long the rival of each case takes, in the same run, at the commits at which `benchmarks/speed.py` was
recorded; up is faster. The figure beside each axis is the last. All plots have one scale: the same slope is the same
factor.
"""


@dataclass(frozen=True)
class Chart:
    """A table of the results, by its heading and columns, as bars."""

    name: str
    heading: str
    label: str
    values: tuple[str, ...]
    title: str
    unit: str
    log: bool = False
    without: tuple[str, ...] = ()


CHARTS = (
    Chart(
        "stages",
        "Whole way",
        "stage",
        ("median s",),
        "Seconds a stage, picture of 1024 px",
        "s",
        without=("whole way",),
    ),
    Chart(
        "kernels", "Kernels against rivals", "step", ("ratio",), "How many times as long the rival takes", "x", log=True
    ),
    Chart(
        "packages",
        "Packages",
        "work",
        ("ratio",),
        "How many times as long the package that is not used takes",
        "x",
        log=True,
    ),
    Chart(
        "noise",
        "Noise in landmarks",
        "points",
        ("error %: as they are", "auto"),
        "Error of noisy landmarks",
        "% of the eyes",
    ),
    Chart(
        "truth",
        "3D ground truth",
        "shape",
        ("of the mean face",),
        "Error in 3D, as a share of the mean face's",
        "of 1",
    ),
    Chart("eos", "Beside eos", "subject", ("ratio",), "How many times as long eos takes for a fit with contours", "x"),
    Chart(
        "driving",
        "Driving",
        "head",
        ("only a neutral frame known",),
        "Error of weights when driven by landmarks",
        "of 1",
    ),
    Chart("faults", "Deliberate faults", "folder", ("caught", "of"), "Deliberate faults that tests notice", "faults"),
)


def drawn_charts() -> list[tuple[Chart, list[str], list[list[float]]]]:
    """Charts whose tables are there, with their labels and numbers."""
    text = _RESULTS.read_text(encoding="utf-8")
    found = []
    for chart in CHARTS:
        section = re.search(rf"^#+ {re.escape(chart.heading)}.*?(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
        rows = _rows(section[0], chart) if section else []
        if rows:
            found.append((chart, [label for label, _ in rows], [values for _, values in rows]))
    return found


def _rows(section: str, chart: Chart) -> list[tuple[str, list[float]]]:
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines() if line[:1] == "|"]
    head = next((k for k, cells in enumerate(lines) if {chart.label, *chart.values} <= set(cells)), None)
    if head is None:
        return []
    columns = [lines[head].index(name) for name in (chart.label, *chart.values)]
    rows = []
    for cells in lines[head + 2 :]:
        if len(cells) != len(lines[head]) or set(cells[columns[0]]) <= {"-", ":"} or cells == lines[head]:
            break
        numbers = [re.search(r"-?\d+(?:\.\d+)?", cells[k]) for k in columns[1:]]
        if all(numbers) and cells[columns[0]] not in chart.without:
            rows.append((cells[columns[0]].replace("`", ""), [float(number[0]) for number in numbers]))
    return rows


def result_plots(app=None) -> None:
    """Write ``docs/_static/plots/*.svg`` and the page that shows them."""
    _PLOTS.mkdir(parents=True, exist_ok=True)
    parts = []
    for chart, labels, values in drawn_charts():
        for theme in ("light", "dark"):
            _draw(chart, labels, values, theme)
        told = "; ".join(
            f"{label} {', '.join(f'{v:g}' for v in row)}" for label, row in zip(labels, values, strict=True)
        )
        parts += [_shown(chart.name, f"{chart.title}. {told}.", theme) for theme in ("light", "dark")]
    runs, cases = ratio_runs(_HISTORY)
    parts.append(_OVER_COMMITS)
    for theme in ("light", "dark"):
        draw_ratios(_PLOTS / f"ratios_{theme}.svg", runs, cases, _INK[theme], _BARS[theme][0])
        parts.append(_shown("ratios", told_ratios(runs, cases), theme))
    text = "\n".join(parts)
    _PAGE.parent.mkdir(exist_ok=True)
    if not _PAGE.exists() or _PAGE.read_text(encoding="utf-8") != text:
        _PAGE.write_text(text, encoding="utf-8")


def _shown(name: str, told: str, theme: str) -> str:
    return f"```{{image}} /_static/plots/{name}_{theme}.svg\n:alt: {told}\n:class: only-{theme}\n```\n"


def _draw(chart: Chart, labels: list[str], values: list[list[float]], theme: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    ink = _INK[theme]
    style = {
        "svg.hashsalt": "toongeo",
        "text.color": ink,
        "axes.labelcolor": ink,
        "xtick.color": ink,
        "ytick.color": ink,
        "axes.edgecolor": ink,
    }
    width = 0.8 / len(chart.values)
    with plt.rc_context(style):
        figure, axes = plt.subplots(
            figsize=(6, 1.1 + 0.3 * len(labels) * len(chart.values) ** 0.5), layout="constrained"
        )
        for k, column in enumerate(chart.values):
            places = [row + (k - (len(chart.values) - 1) / 2) * width for row in range(len(labels))]
            bars = axes.barh(places, [row[k] for row in values], width, color=_BARS[theme][k], label=column)
            axes.bar_label(bars, fmt="%g", padding=3, fontsize=8, color=ink)
        axes.set_yticks(range(len(labels)), labels)
        axes.invert_yaxis()
        axes.set_title(chart.title, loc="left", fontsize=11)
        axes.set_xlabel(chart.unit)
        axes.margins(x=0.12)
        axes.spines[["top", "right"]].set_visible(False)
        if chart.log:
            axes.set_xscale("log")
            axes.axvline(1, color=ink, linewidth=0.8)
        if len(chart.values) > 1:
            axes.legend(frameon=False)
        figure.savefig(_PLOTS / f"{chart.name}_{theme}.svg", transparent=True, metadata={"Date": None})
        plt.close(figure)


def setup(app):
    app.connect("builder-inited", result_plots)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
