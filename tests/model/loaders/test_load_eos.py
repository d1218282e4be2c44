"""The Surrey Face Model from the binary files of eos."""

import numpy as np
import pytest

from toongeo.model.loaders.load_eos import load_eos
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module")
def folder(shared):
    return shared / "data" / "models" / "sfm"


@pytest.fixture(scope="module")
def surrey(folder):
    return load_eos(
        folder / "sfm_shape_3448.bin", folder / "ibug_to_sfm.txt", folder / "expression_blendshapes_3448.bin"
    )


def test_shapes(surrey):
    assert surrey.mean.shape == (3448, 3) and surrey.identity.shape == (63, 3448, 3)
    assert surrey.faces.shape == (6736, 3) and surrey.uv.shape == (3448, 2)
    assert surrey.expression_names == ("anger", "disgust", "fear", "happiness", "sadness", "surprise")
    assert surrey.expression.shape == (6, 3448, 3)
    assert surrey.uv.min() >= 0 and surrey.uv.max() <= 1


def test_the_frame_is_millimetres_between_the_eyes(surrey):
    p = surrey.mean[surrey.landmarks]
    np.testing.assert_allclose(p[[36, 39, 42, 45]].mean(0), [0, 0, 13], atol=1e-9)
    assert p[45, 0] == pytest.approx(46, abs=1) and p[36, 0] == pytest.approx(-46, abs=1)
    assert p[30, 2] > 40 and p[8, 1] < -100
    assert (np.diff(p[:17, 0]) > 0).all()  # the jaw runs from the subject's right to the left


def test_modes_are_orthogonal_and_sorted(surrey):
    flat = surrey.identity.reshape(63, -1).astype(float)
    variances = (flat**2).sum(axis=1)
    np.testing.assert_allclose(flat @ flat.T, np.diag(variances), atol=1e-3 * variances[0])
    assert (np.diff(variances) < 0).all()


def test_without_expressions(folder):
    surrey = load_eos(folder / "sfm_shape_3448.bin", folder / "ibug_to_sfm.txt")
    assert surrey.expression.shape == (0, 3448, 3)
    camera = ScaledOrthographicCamera.look(yaw=-15)
    fit = fit_3dmm(None, camera.project(surrey.mean[surrey.landmarks]), model=surrey)
    assert fit.camera.yaw == pytest.approx(-15, abs=1)


def test_a_file_of_another_kind_is_refused(folder, tmp_path):
    (tmp_path / "bad.bin").write_bytes(np.array([7, 7, 7], "<u4").tobytes())
    with pytest.raises(ValueError, match="expected version 1 of an eos model, got 7"):
        load_eos(tmp_path / "bad.bin", folder / "ibug_to_sfm.txt")
    (tmp_path / "short.bin").write_bytes(np.array([1, 30, 1, 0], "<u4").tobytes())
    with pytest.raises(ValueError, match="expected a binary file of eos, it ends at byte 16"):
        load_eos(tmp_path / "short.bin", folder / "ibug_to_sfm.txt")
    (tmp_path / "negative.bin").write_bytes(np.array([1, -1, 1], "<i4").tobytes())
    with pytest.raises(ValueError, match="got a matrix of -1 x 1"):
        load_eos(tmp_path / "negative.bin", folder / "ibug_to_sfm.txt")


def test_a_table_without_points_is_refused(folder, tmp_path):
    (tmp_path / "few.txt").write_text("[landmark_mappings]\n9 = 33 # chin\n")
    with pytest.raises(ValueError, match="landmarks: expected points 9 and 18-68"):
        load_eos(folder / "sfm_shape_3448.bin", tmp_path / "few.txt")


def test_expressions_of_another_mesh_are_refused(folder, tmp_path):
    head = np.array([1], "<u8").tobytes() + np.array([1], "<u8").tobytes() + b"x"
    (tmp_path / "x.bin").write_bytes(head + np.array([3, 1], "<i4").tobytes() + np.zeros(3, "<f4").tobytes())
    with pytest.raises(ValueError, match="expression: expected 3448 vertices like the shape, got 1"):
        load_eos(folder / "sfm_shape_3448.bin", folder / "ibug_to_sfm.txt", tmp_path / "x.bin")
