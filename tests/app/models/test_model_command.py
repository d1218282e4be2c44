"""``toongeo model info|check|convert|render``."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tests.model.loaders import layouts
from toongeo.app.cli import main
from toongeo.app.models.model_faults import model_faults
from toongeo.app.models.model_sheet import model_sheet
from toongeo.io import read_image
from toongeo.model import load_model, save_model
from toongeo.model.ibug68 import MIRROR


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return layouts.deep3d(layouts.Face(), tmp_path_factory.mktemp("model") / "BFM_model_front.mat")


def test_info_says_what_there_is_and_what_not(file, capsys):
    assert main(["model", "info", str(file)]) == 0
    said = capsys.readouterr().out
    for text in ("format: bfm2009", "vertices: 550, triangles: 1008", "identity: 6 modes", "landmarks: 68",
                 "missing: texture coordinates", "missing: contour lines", "missing: rig"):  # fmt: skip
        assert text in said


def test_convert_supplies_what_is_asked_for(file, tmp_path, capsys):
    assert main(["model", "convert", str(file), "--contours", "--uv", "-o", str(tmp_path / "m.npz")]) == 0
    model = load_model(tmp_path / "m.npz")
    assert model.has("contours", "uv", "landmarks")
    np.testing.assert_array_equal(model.identity, load_model(file).identity)
    assert main(["model", "convert", str(file), "-o", str(file)]) == 2
    assert main(["model", "convert", str(file), "-o", str(tmp_path / "m.glb")]) == 2
    assert "expected .npz" in capsys.readouterr().err


def test_render_draws_everything_on_one_sheet(file, tmp_path):
    assert main(["model", "render", str(file), "-o", str(tmp_path / "m.png")]) == 0
    sheet = read_image(tmp_path / "m.png")
    assert sheet.shape == (280 * (1 + 2 + 1 + 3), 6 * 280, 3)
    tiles = sheet[: 4 * 280].reshape(4, 280, 6, 280, 3).swapaxes(1, 2)
    assert all(np.ptp(tile) > 50 for tile in tiles[:3].reshape(-1, 280, 280, 3))
    bare = replace(
        load_model(file), expression=np.zeros(0), expression_names=(), landmarks=np.zeros(0, int), contour_lines=()
    )
    assert model_sheet(bare, tile=64).shape == (64 * 3, 384, 3)


def test_check_finds_a_wrong_table(model, tmp_path, capsys):
    assert model_faults(model) == []
    exchanged = replace(model, landmarks=model.landmarks[MIRROR], contour_lines=())
    assert any("sides exchanged" in fault for fault in model_faults(exchanged))
    assert any("left and right are exchanged" in fault for fault in model_faults(exchanged))
    turned = replace(model, landmarks=np.roll(model.landmarks, 20), contour_lines=())
    assert any("off by" in fault for fault in model_faults(turned))
    small = replace(model, mean=0.1 * model.mean)
    assert any("9 mm apart" in fault for fault in model_faults(small))
    strong = replace(model, identity=np.concatenate([model.identity[:-1], 100 * model.identity[:1]]))
    assert any(f"mode {len(model.identity) - 1} moves vertices" in fault for fault in model_faults(strong))
    still = replace(model, identity=np.concatenate([model.identity[:-1], 0 * model.identity[:1]]))
    assert any("1 modes move nothing" in fault for fault in model_faults(still))
    flat = replace(model, faces=np.vstack([model.faces, model.faces[:1, [0, 0, 1]]]))
    assert any("have no area" in fault for fault in model_faults(flat))
    twice = replace(model, faces=np.vstack([model.faces, model.faces[:1]]))
    assert any("run the same way" in fault for fault in model_faults(twice))
    loose = replace(model, faces=model.faces[(model.faces != 0).all(1)])
    assert any("1 vertices are in no triangle" in fault for fault in model_faults(loose))
    none = replace(model, landmarks=np.zeros(0, int), contour_lines=())
    assert model_faults(none) == ["landmarks: there are none; a fit needs 68"]
    save_model(exchanged, tmp_path / "bad.npz")
    assert main(["model", "check", str(tmp_path / "bad.npz")]) == 2
    assert "look wrong" in capsys.readouterr().err


def test_landmarks_are_given_by_a_file(tmp_path, capsys):
    face = layouts.Face()
    file = layouts.bfm2009(face, tmp_path / "01_MorphableModel.mat")
    (tmp_path / "picked.json").write_text(json.dumps(face.landmarks.tolist()))
    assert main(["model", "info", str(file), "--landmarks", str(tmp_path / "picked.json")]) == 0
    assert "landmarks: 68, jaw points slide" in capsys.readouterr().out
