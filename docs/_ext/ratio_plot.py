"""The ratios to rivals over the recorded runs of ``benchmarks/speed.py``, as small plots side by side."""

import csv
from pathlib import Path

__all__ = ["draw_ratios", "ratio_runs", "told_ratios"]


def ratio_runs(path: Path) -> tuple[list[str], dict[str, list[float]]]:
    """Runs (date and commit, in their order), and the ratios of every case in them.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "history.csv"
    ...     _ = path.write_text("date,commit,case,ratio\\n2026-01-02,abc,fit,0.7\\n2026-01-03,abd,fit,0.8\\n")
    ...     ratio_runs(path)
    (['2026-01-02 abc', '2026-01-03 abd'], {'fit': [0.7, 0.8]})
    """
    with path.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    runs = list(dict.fromkeys(f"{row['date']} {row['commit']}" for row in rows))
    cases: dict[str, list[float]] = {}
    for row in rows:
        cases.setdefault(row["case"], []).append(float(row["ratio"]))
    return runs, cases


def told_ratios(runs: list[str], cases: dict[str, list[float]]) -> str:
    """What the plot shows, in words."""
    told = "; ".join(f"{name} {', '.join(f'{value:g}' for value in ratios)}" for name, ratios in cases.items())
    return f"How many times as long the rival takes, in the runs {', '.join(runs)}: {told}."


def draw_ratios(path: Path, runs: list[str], cases: dict[str, list[float]], ink: str, line: str) -> None:
    """An SVG with a plot for each case; all have the same height for a factor, so that slopes can be compared."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    columns = 4
    rows = -(-len(cases) // columns)
    widest = max(max(ratios) / min(ratios) for ratios in cases.values())
    reach = (
        max(widest, 2.0) ** 0.75
    )  # about the middle of each: room for what changed most, and at least a factor of 2.8
    style = {
        "svg.hashsalt": "toongeo",
        "text.color": ink,
        "axes.edgecolor": ink,
        "xtick.color": ink,
        "ytick.color": ink,
    }
    with plt.rc_context(style):
        figure, axes = plt.subplots(rows, columns, figsize=(8, 1.7 * rows + 0.3), squeeze=False, layout="constrained")
        for axis, (name, ratios) in zip(axes.flat, cases.items(), strict=False):
            middle = (max(ratios) * min(ratios)) ** 0.5
            axis.plot(range(len(ratios)), ratios, "o-", color=line, markersize=4, linewidth=1.5)
            axis.set(yscale="log", ylim=(middle / reach, middle * reach), xlim=(-0.4, len(runs) - 0.6))
            axis.minorticks_off()
            axis.set_yticks([ratios[-1]], [f"{ratios[-1]:.3g} x"], fontsize=8)
            axis.set_xticks(range(len(runs)), [run.split()[1] for run in runs], fontsize=6, rotation=30)
            axis.set_title(name, loc="left", fontsize=8)
            axis.spines[["top", "right"]].set_visible(False)
        for axis in axes.flat[len(cases) :]:
            axis.axis("off")
        figure.savefig(path, transparent=True, metadata={"Date": None})
        plt.close(figure)
