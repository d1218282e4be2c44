"""``toongeo stylize`` from the command line."""

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo import read_image, read_landmarks, stylize
from toongeo.app.cli import main

PICTURE, POINTS = PORTRAITS / "bad_guy.png", PORTRAITS / "bad_guy.pts"


def test_the_drawing_is_written(tmp_path):
    out = tmp_path / "out.png"
    assert main(["stylize", str(PICTURE), "--landmarks", str(POINTS), "--style", "ink", "-o", str(out)]) == 0
    np.testing.assert_array_equal(read_image(out), stylize(read_image(PICTURE), read_landmarks(POINTS), "ink").img)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["-o", "out.glb"], "--output: expected a name that ends in .png"),
        (["-o", "out.png", "--strength", "3"], "--strength: expected a number in [0, 2], got 3.0"),
        (["-o", str(PICTURE)], "--output: expected no file that is read"),
    ],
)
def test_what_is_refused_before_the_work(more, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["stylize", str(PICTURE), "--landmarks", str(POINTS), *more]) == 2
    assert message in capsys.readouterr().err and not list(tmp_path.iterdir())
