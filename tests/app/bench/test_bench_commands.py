"""``toongeo bench`` from folder to files."""

import csv
import json
import sys
from functools import partial

import cv2
import numpy as np
import pytest

from toongeo.app.bench import caricature_methods
from toongeo.app.bench.blind_sheets import QUESTIONS
from toongeo.app.bench.eos_rival import EosRival
from toongeo.app.bench.method_errors import method_errors
from toongeo.app.bench.pair_sheets import pair_sheets
from toongeo.app.bench.score_answers import score_answers
from toongeo.app.cli import main
from toongeo.avatar.make_avatar import STAGES
from toongeo.caricature.baselines.bilinear_model import BilinearModel
from toongeo.caricature.baselines.caricatured_modes import caricatured_modes
from toongeo.io import read_image

PARTS = ["eyes", "nose", "brow", "mouth", "contour", "total"]


def rows_of(path):
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.slow
def test_table1_prints_and_writes_coarse_and_fine(folder, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["bench", "table1", str(folder), "-o", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "fine / coarse, paper: eyes 0.084" in printed and "total 0.293, photometric 0.254" in printed
    rows = rows_of(out / "table1.csv")
    assert len(rows) == 3 * (2 + 2)
    error = {(row["picture"], row["method"]): {part: float(row[part]) for part in PARTS} for row in rows}
    for name in ("blue_girl.png", "moustache_man.png"):
        assert error[name, "mean face"]["total"] > error[name, "coarse"]["total"] > error[name, "fine"]["total"]
        assert error[name, "fine"]["total"] < 0.05
    colour = {row["method"]: float(row["photometric"]) for row in rows if row["picture"] == "mean"}
    assert colour["fine"] < 0.5 * colour["coarse"] < 0.5 * 765
    assert {path.name for path in out.iterdir()} == {"table1.csv", "table1.png"}
    assert read_image(out / "table1.png").std() > 10


@pytest.mark.slow
def test_errors_do_not_depend_on_the_resolution(cartoon):
    img, landmarks = cartoon("blue_girl")
    twice = cv2.resize(img, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC)
    small = method_errors(img, landmarks, adjusted=True)
    large = method_errors(twice, 2 * (landmarks + 0.5) - 0.5, adjusted=True)
    assert list(small) == ["mean face", "coarse", "adjust exp", "adjust id+exp", "fine"]
    assert large["mean face"]["total"] == pytest.approx(small["mean face"]["total"], rel=1e-3)
    assert large["coarse"]["total"] == pytest.approx(small["coarse"]["total"], rel=0.1)
    assert large["coarse"]["photometric"] == pytest.approx(small["coarse"]["photometric"], rel=0.1)
    assert small["adjust id+exp"]["total"] < small["adjust exp"]["total"] < small["coarse"]["total"]


def test_table2_prints_what_adjusting_reaches(folder, capsys):
    (folder / "moustache_man.png").unlink()
    assert main(["bench", "table2", str(folder)]) == 0
    lines = capsys.readouterr().out.splitlines()
    methods = ["mean face", "coarse", "adjust exp", "adjust id+exp", "fine"]
    assert [line[: len(method)] for line, method in zip(lines[3:], methods, strict=False)] == methods
    assert lines[-1].startswith("total, paper: adjust exp 143.38, adjust id+exp 110.70, fine 37.44")


@pytest.mark.slow
def test_table4_adds_up(folder, tmp_path, capsys):
    (folder / "moustache_man.png").unlink()
    assert main(["bench", "table4", str(folder), "-o", str(tmp_path)]) == 0
    row = rows_of(tmp_path / "table4.csv")[0]
    stages = [float(value) for name, value in row.items() if name not in ("picture", "method", "total")]
    assert len(stages) == len(STAGES) - 1 and sum(stages) == pytest.approx(float(row["total"]))
    assert "paper 20.02 s" in capsys.readouterr().out


@pytest.mark.slow
def test_caricature_compares_the_baselines(folder, tmp_path, capsys, monkeypatch):
    # The baselines' models of fewer people than the command takes.
    monkeypatch.setattr(caricature_methods, "caricatured_modes", partial(caricatured_modes, identities=8))
    few = partial(BilinearModel.from_model, identities=60)
    monkeypatch.setattr(caricature_methods.BilinearModel, "from_model", few)
    (folder / "moustache_man.png").unlink()
    assert main(["bench", "caricature", str(folder), "-o", str(tmp_path)]) == 0
    rows = {row["method"]: row for row in rows_of(tmp_path / "caricature.csv") if row["picture"] not in ("mean", "sd")}
    errors = {method: float(row["E_error"]) for method, row in rows.items()}
    plain = {"3DMM", "3DMM(-)", "bilinear", "caricatured 3DMM", "fit_3dmm"}
    assert plain < set(errors) and len(errors) == 11
    bent = set(errors) - plain
    assert max(errors[method] for method in bent) < 0.03 < min(errors[method] for method in plain)
    ours, arap = rows["fit_caricature"], rows["fit_3dmm + ARAP"]
    assert float(ours["bending"]) < float(arap["bending"]) and float(ours["held out"]) < float(arap["held out"])
    assert rows["bilinear"]["held out"] == ""
    assert "paper, Table 1" in capsys.readouterr().out


@pytest.mark.slow
def test_pairs_are_blind_and_score_goes_the_whole_way(folder, tmp_path, capsys):
    out = tmp_path / "pairs"
    assert main(["bench", "pairs", str(folder), "-o", str(out), "--seed", "7"]) == 0
    assert {path.name for path in out.iterdir()} == {".key.json", "answers.csv", "pair-01.png", "pair-02.png"}
    pairs = json.loads((out / ".key.json").read_text())["pairs"]
    assert sorted(pair["picture"] for pair in pairs.values()) == ["blue_girl.png", "moustache_man.png"]
    assert [pair["A"] for pair in pairs.values()].count("ours") == 1
    form = rows_of(out / "answers.csv")
    assert [(row["picture"], row["question"], row["answer"]) for row in form] == [
        (name, question, "") for name in pairs for question in QUESTIONS
    ]
    sheet = read_image(out / "pair-01.png")
    left, right = sheet[360:, :720], sheet[360:, -720:]
    assert sheet.shape == (720, 1464, 3) and np.abs(left[60:].astype(int) - right[60:]).max() > 50

    favourite = {name: next(letter for letter in "AB" if pair[letter] == "ours") for name, pair in pairs.items()}
    filled = [f"{row['picture']},{row['question']},{favourite[row['picture']]}" for row in form]
    (tmp_path / "filled.csv").write_text("\n".join(["picture,question,answer", *filled]))
    assert all((p.first, p.second, p.p_value) == (2, 0, 0.5) for p in score_answers(
        tmp_path / "filled.csv", out / ".key.json"
    ))  # fmt: skip
    assert main(["bench", "score", str(tmp_path / "filled.csv"), str(out / ".key.json")]) == 0
    assert "100.0 %" in capsys.readouterr().out

    before = (out / "pair-01.png").read_bytes()
    assert main(["bench", "pairs", str(folder), "-o", str(out)]) == 2  # answers would be lost
    assert "answers.csv is there already" in capsys.readouterr().err
    assert (out / "pair-01.png").read_bytes() == before


@pytest.mark.parametrize("command", ["table1", "table2", "table4", "caricature", "pairs"])
def test_bad_folders_are_one_line_and_exit_code_2(command, folder, tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    (folder / "moustache_man.txt").unlink()
    for where, message in ((tmp_path / "empty", "expected pictures"), (folder, "got none for moustache_man.png")):
        assert main(["bench", command, str(where), "-o", str(tmp_path / "out")]) == 2
        error = capsys.readouterr().err.splitlines()
        assert len(error) == 1 and error[0].startswith("toongeo: FOLDER: ") and message in error[0]
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", ["table1", "table2", "table4", "caricature", "pairs"])
def test_an_output_that_is_a_file_is_refused_before_the_work(command, folder, tmp_path, capsys):
    (tmp_path / "out").write_text("precious")
    assert main(["bench", command, str(folder), "-o", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.startswith("toongeo: --output: expected a folder, got the file ")
    assert (tmp_path / "out").read_text() == "precious"


@pytest.mark.parametrize("command", ["table1", "pairs"])
def test_a_picture_that_cannot_be_used_is_named(command, folder, tmp_path, capsys):
    (folder / "blue_girl.pts").unlink()
    np.savetxt(folder / "blue_girl.txt", np.ones((68, 2)))
    assert main(["bench", command, str(folder), "-o", str(tmp_path / "out")]) == 2
    assert "toongeo: blue_girl.png: landmarks" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_bad_options_are_named(folder, tmp_path):
    with pytest.raises(ValueError, match="against: expected one of coarse, adjust, got 'eos'"):
        pair_sheets(folder, tmp_path, against="eos")
    with pytest.raises(ValueError, match="seed: expected an integer >= 0, got -1"):
        pair_sheets(folder, tmp_path, seed=-1)


def test_eos_without_its_package_or_files_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "eos", None)
    with pytest.raises(ValueError, match="eos: expected eos-py, which is not installed"):
        EosRival(tmp_path)
    monkeypatch.setitem(sys.modules, "eos", object())
    with pytest.raises(ValueError, match="eos: expected the file sfm_shape_3448.bin in"):
        EosRival(tmp_path)
