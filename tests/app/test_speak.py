"""A face that speaks, from the command line."""

import csv

import numpy as np
import pytest
import scipy.io.wavfile

from toongeo.app import speak as module
from toongeo.app.cli import main
from toongeo.app.read_take import read_take
from toongeo.io import has_sound
from toongeo.model.expression_schemes import EXPRESSIONS

JAW = EXPRESSIONS.index("jawOpen")


@pytest.fixture(scope="module")
def glb(avatar, tmp_path_factory):
    path = tmp_path_factory.mktemp("speak") / "face.glb"
    avatar.save(path)
    return path


@pytest.fixture
def cues(tmp_path):
    path = tmp_path / "cues.tsv"
    path.write_text("0.00\tX\n0.20\tD\n0.40\tA\n0.50\tX\n")
    return path


@pytest.fixture
def voice(tmp_path):
    times = np.arange(16000) / 16000
    sound = sum(np.sin(2 * np.pi * 120 * k * times) / k for k in range(1, 30))
    scipy.io.wavfile.write(tmp_path / "a.wav", 16000, (5000 * np.where(times > 0.5, sound, 0)).astype(np.int16))
    return tmp_path / "a.wav"


def test_cues_become_a_table(glb, cues, tmp_path, capsys):
    out = tmp_path / "out.csv"
    assert main(["speak", str(glb), "--visemes", str(cues), "-o", str(out), "--fps", "50"]) == 0
    take = read_take(out)
    jaw = take.weights[:, JAW]
    assert jaw[15] > 0.5 and jaw[0] < 0.1 and jaw[-1] < 0.1
    assert take.weights[22, EXPRESSIONS.index("mouthPressLeft")] > 0.4
    assert "wrote" in capsys.readouterr().out


def test_a_video_has_the_sound(glb, cues, voice, tmp_path, capsys, monkeypatch):
    pytest.importorskip("av")
    out = tmp_path / "out.mp4"
    arguments = ["speak", str(glb), "--audio", str(voice), "-o", str(out), "--size", "32", "--fps", "5"]
    assert main(arguments) == 0
    assert has_sound(out)
    assert "note: the mouth moves with the sound alone: it is no lip-reading" in capsys.readouterr().err
    assert main([*arguments, "--visemes", str(cues)]) == 0
    assert has_sound(out) and "lip-reading" not in capsys.readouterr().err
    monkeypatch.setattr(module, "has_pyav", lambda: False)
    assert main(arguments) == 0
    assert not has_sound(out)
    assert 'note: the video is silent; its sound needs the extra video: pip install "av>=14"' in capsys.readouterr().err


def test_bad_input_is_one_line(glb, cues, tmp_path, capsys):
    before = sorted(path.name for path in tmp_path.iterdir())
    with open(tmp_path / "bad.json", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerow(["no", "json"])
    for options, message in (
        ([], "visemes, sound: expected one of them, got neither"),
        (["--visemes", str(tmp_path / "bad.json")], "bad.json: line 1: expected a time and a letter"),
        (["--visemes", str(cues), "-o", str(cues)], "output: expected a name that ends in .mp4"),
        (["--visemes", str(tmp_path / "none.tsv")], "none.tsv"),
    ):
        assert main(["speak", str(glb), "-o", str(tmp_path / "out.mp4"), *options]) == 2
        assert message in capsys.readouterr().err
    (tmp_path / "bad.json").unlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == before
