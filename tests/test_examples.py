"""The examples that need nothing but the library run, and say what they promise."""

import re
import runpy

from tests.conftest import ROOT


def test_bend_a_bar(capsys):
    names = runpy.run_path(str(ROOT / "examples" / "bend_a_bar.py"))
    plain, turned = map(float, re.findall(r"plain ([\d.]+), with rotations ([\d.]+)", capsys.readouterr().out)[0])
    assert turned < 0.2 < plain
    assert names["sheet"].shape == (512, 768, 3)
