"""Ratios that are compared with committed ones."""

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


def test_the_committed_cases_are_those_that_are_measured(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import speed as script

    assert list(script.committed()) == list(script.CASES)
    for name, case in script.CASES.items():
        if name.startswith(("align", "transfer")):  # of the quick ones: both sides run
            ours, _, rival = case()
            ours(), rival()
