"""Ratios that are compared with committed ones."""

import csv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def speed(monkeypatch, tmp_path):
    """The script, with a clock of its own: a run of ours takes 1 s, of the rival as many as the case says."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import speed as script

    now = [0.0]
    monkeypatch.setattr(script.time, "process_time", lambda: now[0])

    def runs(slowness):
        left = list(slowness)

        def ours():
            now[0] += 1.0

        def rival():
            now[0] += left.pop(0) if len(left) > 1 else left[0]

        return lambda: (ours, "a rival", rival)

    monkeypatch.setattr(script, "RATIOS", tmp_path / "ratios.csv")
    monkeypatch.setattr(script, "HISTORY", tmp_path / "benchmarks" / "ratio_history.csv")
    script.HISTORY.parent.mkdir()
    script.HISTORY.write_text("date,commit,case,ratio\n", encoding="utf-8")
    return script, runs


@pytest.mark.parametrize(
    ("ratios", "code", "word"),
    [
        ([4.0], 0, "ok: a: 4.00"),
        ([2.9], 0, "ok: a: 2.90"),  # worse by 28 %
        ([2.7], 1, "WORSE: a: 2.70"),
        ([4.0, 1, 4, 1, 4, 4, 4], 0, "ok: a: 4.00"),  # a median minds no outlier
        ([1.0] * 6 + [4.0], 0, "ok: a: 4.00"),  # noise that is over when it is measured again
    ],
)
def test_only_a_ratio_that_stays_worse_fails(speed, monkeypatch, capsys, ratios, code, word):
    script, runs = speed
    monkeypatch.setattr(script, "CASES", {"a": runs([4.0])})
    script.record()
    assert script.committed() == {"a": 4.0}
    monkeypatch.setattr(script, "CASES", {"a": runs(ratios)})
    assert script.check() == code
    assert capsys.readouterr().out.startswith(word)


def test_recorded_runs_are_added_to_the_history_and_quick_ones_are_not(speed, monkeypatch, capsys):
    script, runs = speed
    for part in ("by_vertices", "by_modes", "by_faces", "processes"):
        monkeypatch.setattr(script, part, lambda *_: None)
    for slowness, arguments in ((4.0, ["--record"]), (2.0, []), (9.0, ["--quick"])):
        monkeypatch.setattr(script, "CASES", {"a, b": runs([slowness])})
        monkeypatch.setattr(script.sys, "argv", ["speed.py", *arguments])
        assert script.main() == 0
    assert capsys.readouterr().out.count("| a, b | 1000.0 | a rival |") == 2
    lines = script.HISTORY.read_text(encoding="utf-8").splitlines()
    assert [line.partition(',"')[2] for line in lines] == ["", 'a, b",4.00', 'a, b",2.00']
    assert all(line.startswith(script.origin(ROOT)["date"]) for line in lines[1:])


def test_the_history_has_every_case_of_each_run():
    with (ROOT / "benchmarks" / "ratio_history.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    with (ROOT / "benchmarks" / "ratios.csv").open(newline="", encoding="utf-8") as stream:
        cases = [row["case"] for row in csv.DictReader(stream)]
    assert len(rows) % len(cases) == 0
    for k in range(0, len(rows), len(cases)):
        run = rows[k : k + len(cases)]
        assert [row["case"] for row in run] == cases
        assert len({(row["date"], row["commit"]) for row in run}) == 1
        assert all(float(row["ratio"]) > 0 for row in run)


def test_the_committed_cases_are_those_that_are_measured(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import speed as script

    assert list(script.committed()) == list(script.CASES)
    for name, case in script.CASES.items():
        if name.startswith(("align", "transfer")):  # of the quick ones: both sides run
            ours, _, rival = case()
            ours(), rival()
