"""Renders of two folders, blind."""

import json
import shutil

import numpy as np
import pytest
from PIL import Image

from toongeo.app.bench.render_pairs import render_pairs
from toongeo.app.cli import main
from toongeo.io import read_image

SIZE = 48


@pytest.fixture
def folders(tmp_path):
    """Six grey pictures in each, the new ones lighter; the last is the same in both."""
    old, new = tmp_path / "before", tmp_path / "after"
    for folder, light in ((old, 0), (new, 100)):
        folder.mkdir()
        for k in range(6):
            grey = np.full((SIZE, SIZE + k, 3), 20 + 10 * k + light * (k < 5), np.uint8)
            Image.fromarray(grey).save(folder / f"face{k}.png")
    return old, new


def sheets_of(out):
    key = json.loads((out / ".key.json").read_text())
    return key, {name: read_image(out / f"{name}.png") for name in key["pairs"]}


def test_every_sheet_shows_what_the_key_says(folders, tmp_path):
    old, new = folders
    paths = render_pairs(old, new, tmp_path / "out", seed=5)
    key, sheets = sheets_of(tmp_path / "out")
    assert [path.stem for path in paths] == list(sheets) and (key["old"], key["new"]) == ("before", "after")
    assert sorted(pair["picture"] for pair in key["pairs"].values()) == [f"face{k}.png" for k in range(5)]
    assert sorted(pair["A"] for pair in key["pairs"].values()).count("new") in (2, 3)
    for name, sheet in sheets.items():
        pair = key["pairs"][name]
        a, b = (read_image({"old": old, "new": new}[pair[letter]] / pair["picture"]) for letter in "AB")
        width = a.shape[1]
        assert sheet.shape == (SIZE, 2 * width + 24, 3)
        # Beneath the letters nothing is painted over.
        np.testing.assert_array_equal(sheet[40:, :width], a[40:])
        np.testing.assert_array_equal(sheet[40:, -width:], b[40:])
        assert (sheet[:, width : width + 24] == 255).all()


def test_the_seed_decides_the_order(folders, tmp_path):
    keys = []
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        render_pairs(*folders, tmp_path / name, seed=seed)
        keys.append(sheets_of(tmp_path / name)[0]["pairs"])
    assert keys[0] == keys[1] != keys[2]


def test_inputs_stand_on_top_at_the_height_of_the_renders(folders, tmp_path):
    inputs = tmp_path / "inputs"
    inputs.mkdir()
    for k in range(6):
        Image.fromarray(np.full((2 * SIZE, 20, 3), 7 * k, np.uint8)).save(inputs / f"face{k}.bmp")
    render_pairs(*folders, tmp_path / "out", inputs=inputs)
    key, sheets = sheets_of(tmp_path / "out")
    for name, sheet in sheets.items():
        k = int(key["pairs"][name]["picture"][4])
        first = (sheet.shape[1] - 10) // 2
        assert sheet.shape[0] == 2 * SIZE
        assert (sheet[:SIZE, first : first + 10] == 7 * k).all()
        assert (sheet[:SIZE, :first] == 255).all() and (sheet[:SIZE, first + 10 :] == 255).all()


def test_the_command_goes_the_whole_way(folders, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["bench", "pairs", *map(str, folders), "-o", str(out), "--seed", "3"]) == 0
    assert "wrote 5 sheets" in capsys.readouterr().out
    key, sheets = sheets_of(out)
    lines = [f"{name},accuracy,{'A' if key['pairs'][name]['A'] == 'new' else 'B'}" for name in sheets]
    (tmp_path / "filled.csv").write_text("\n".join(["picture,question,answer", *lines]))
    assert main(["bench", "score", str(tmp_path / "filled.csv"), str(out / ".key.json")]) == 0
    assert capsys.readouterr().out.splitlines()[2].split() == ["accuracy", "5", "0", "100.0", "%", "0.0625"]
    assert main(["bench", "pairs", *map(str, folders), "-o", str(out)]) == 2
    assert "is there already" in capsys.readouterr().err
    for arguments, message in (
        (["bench", "pairs", *map(str, folders), "-o", str(folders[1])], "output: expected another folder than that"),
        (["bench", "pairs", *map(str, folders), "-o", "x", "--against", "coarse"], "against: expected no baseline"),
        (["bench", "pairs", str(folders[0]), "-o", "x", "--inputs", "y"], "inputs: expected two folders"),
    ):
        assert main(arguments) == 2
        assert message in capsys.readouterr().err


def test_folders_that_do_not_go_together_are_named(folders, tmp_path):
    old, new = folders
    out = tmp_path / "out"
    with pytest.raises(NotADirectoryError, match="old: expected a folder of pictures, got .*none"):
        render_pairs(tmp_path / "none", new, out)
    (tmp_path / "empty").mkdir()
    with pytest.raises(ValueError, match=r"new: expected pictures \(.*\), got none in .*empty"):
        render_pairs(old, tmp_path / "empty", out)
    with pytest.raises(ValueError, match="new: expected pictures that differ .* got 6 that are the same"):
        render_pairs(old, old, out)
    with pytest.raises(ValueError, match="seed: expected an integer >= 0, got -1"):
        render_pairs(old, new, out, seed=-1)
    with pytest.raises(ValueError, match="inputs: expected a picture face0, got none in .*empty"):
        render_pairs(old, new, out, inputs=tmp_path / "empty")
    (new / "face3.png").rename(new / "face7.png")
    with pytest.raises(ValueError, match=r"new: expected a picture face3.png as in .*, got none in .*after"):
        render_pairs(old, new, out)
    shutil.copy(new / "face7.png", new / "face3.png")
    with pytest.raises(ValueError, match=r"old: expected a picture face7.png as in .*, got none in .*before"):
        render_pairs(old, new, out)
    (new / "face7.png").unlink()
    Image.fromarray(np.zeros((5, 9, 3), np.uint8)).save(new / "face3.png")
    with pytest.raises(ValueError, match=r"new: expected two pictures face3.png of one size, got 51 x 48 and 9 x 5 px"):
        render_pairs(old, new, out)
    assert not out.exists()
