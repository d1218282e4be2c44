"""Expressions beside the original Basel Face Model, in the published layout."""

import struct

import numpy as np
import pytest

from tests.model.loaders import layouts
from toongeo.app.cli import main
from toongeo.model import load_model

STD = np.array([3.0, 2.0, 1.0, 0.5])


@pytest.fixture
def face():
    return layouts.Face()


@pytest.fixture
def kept():
    """Which vertices the expressions move, in an order of their own."""
    rng = np.random.default_rng(3)
    return rng.permutation(layouts.N)[: layouts.N - 40]


@pytest.fixture
def files(face, kept, tmp_path):
    layouts.bfm2009(face, tmp_path / "01_MorphableModel.mat")
    basis = 1000 * face.expression[:, kept] / STD[:, None, None]
    numbers = np.concatenate([np.full(3 * len(kept), 9e9), basis.ravel()]).astype("<f4")
    (tmp_path / "Exp_Pca.bin").write_bytes(struct.pack("<i", len(STD)) + numbers.tobytes())
    (tmp_path / "std_exp.txt").write_text(" ".join(map(str, STD)))
    (tmp_path / "BFM_exp_idx.mat").write_bytes(layouts._mat({"trimIndex": kept[:, None] + 1.0}))
    return tmp_path


def test_expressions_join_the_vertices_that_they_move(files, face, kept, capsys):
    model = load_model(files / "01_MorphableModel.mat", expression=files / "Exp_Pca.bin")
    whole = load_model(files / "01_MorphableModel.mat")
    np.testing.assert_allclose(model.expression, face.expression[:, kept], rtol=2e-5, atol=2e-4)
    np.testing.assert_array_equal(model.identity, whole.identity[:, kept])
    np.testing.assert_array_equal(model.albedo_mean, whole.albedo_mean[kept])
    np.testing.assert_allclose(model.mean - model.mean[0], whole.mean[kept] - whole.mean[kept[0]], atol=1e-9)
    inside = np.isin(whole.faces, kept).all(axis=1)
    np.testing.assert_array_equal(kept[model.faces], whole.faces[inside])
    arguments = [str(files / "01_MorphableModel.mat"), "--expression", str(files / "Exp_Pca.bin")]
    assert main(["model", "info", *arguments]) == 0
    assert "expressions: 0 named, 4 others" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("Exp_Pca.bin", b"", "0 modes and a mean do not fit into 0 bytes"),
        ("Exp_Pca.bin", struct.pack("<i", 10**9) + bytes(60), "1000000000 modes"),
        ("Exp_Pca.bin", struct.pack("<i", -1) + bytes(60), "-1 modes"),
        ("Exp_Pca.bin", struct.pack("<i", 1) + np.full(6, np.nan, "<f4").tobytes(), "not finite"),
        ("Exp_Pca.bin", struct.pack("<i", 4) + bytes(60), "expected 1 vertices from 1 as trimIndex, got 510"),
        ("std_exp.txt", b"1 2 3", "expected 4 standard deviations, but .*got 3 numbers"),
        ("std_exp.txt", b"1 2 3 x", "expected 4 standard deviations"),
        ("std_exp.txt", b"1 2 3 -4", "expected 4 standard deviations"),
        ("BFM_exp_idx.mat", layouts._mat({"idx": np.ones(3)}), "expected 510 vertices from 1 as trimIndex, got 0"),
        ("BFM_exp_idx.mat", layouts._mat({"trimIndex": np.ones(510)}), "are there twice"),
        ("BFM_exp_idx.mat", layouts._mat({"trimIndex": 1000.0 + np.arange(510)}), "vertices are not all in 0..549"),
    ],
)
def test_what_does_not_fit_is_refused(files, name, content, message):
    (files / name).write_bytes(content)
    with pytest.raises(ValueError, match=message):
        load_model(files / "01_MorphableModel.mat", expression=files / "Exp_Pca.bin")


@pytest.mark.parametrize("name", ["std_exp.txt", "BFM_exp_idx.mat"])
def test_what_is_missing_is_named(files, name):
    (files / name).unlink()
    with pytest.raises(OSError, match=name):
        load_model(files / "01_MorphableModel.mat", expression=files / "Exp_Pca.bin")


def test_models_that_have_their_own_take_none(face, files):
    layouts.deep3d(face, files / "front.mat")
    with pytest.raises(ValueError, match="expected the original model to go with expression"):
        load_model(files / "front.mat", expression=files / "Exp_Pca.bin")
    layouts.gnm(face, files / "gnm.npz")
    with pytest.raises(ValueError, match="expression: expected a model of eos or the Basel .*, got gnm"):
        load_model(files / "gnm.npz", expression=files / "Exp_Pca.bin")
