"""ICT-FaceKit in the frame of this library."""

import numpy as np
import pytest

from toongeo.model import load_model
from toongeo.model.ibug68 import PARTS
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module")
def path(shared):
    return shared / "data" / "models" / "ict_facekit" / "ict_facekit_light.npz"


@pytest.fixture(scope="module")
def ict(path):
    return load_ict_facekit(path)


def test_shapes(ict):
    n = 11248
    assert ict.mean.shape == (n, 3) and ict.identity.shape == (100, n, 3) and ict.expression.shape == (57, n, 3)
    assert ict.faces.max() < n and ict.faces.min() == 0 and len(ict.faces) == len(ict.uv_faces)
    assert ict.n_named == len(ict.expression_names) == 57 and ict.eyes == ()
    assert ict.uv_faces.max() < len(ict.uv)


def test_the_frame_is_millimetres_between_the_eyes(ict):
    p = ict.mean[ict.landmarks]
    np.testing.assert_allclose(p[45] - p[36], [89.18, 0, 0], atol=0.01)  # the outer eye corners, 8.918 cm in the file
    np.testing.assert_allclose(p[PARTS["eye_left"]].mean(0), p[PARTS["eye_right"]].mean(0) * [-1, 1, 1], atol=0.1)
    assert p[42, 0] > 10  # the subject's left is +X
    assert p[30, 2] > 40 and p[8, 1] < -100  # the tip of the nose is in front, the chin below


def test_coefficients_are_those_of_the_file(path, ict):
    with np.load(path) as z:
        expected = z["neutral"] + 2.0 * z["identity_q"][3] * z["identity_scale"][3]
        expected = 10 * (expected + z["expression_q"][30] * z["expression_scale"][30])[:11248]
    found = ict.vertices(2 * np.eye(100)[3], np.eye(57)[30])
    shift = found - expected
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0], shift.shape), atol=1e-3)


def test_triangles_face_outwards_and_mirror(ict):
    a, b, c = (ict.mean[ict.faces[:, i]] for i in range(3))
    facing = np.cross(b - a, c - a)[ict.region("narrow_face")[ict.faces].all(1), 2]
    assert (facing > 0).mean() > 0.8
    np.testing.assert_allclose(ict.mean[ict.mirror] * [-1, 1, 1], ict.mean, atol=0.1)


def test_its_own_face_is_recognised(ict):
    truth = 0.7 * np.random.default_rng(5).standard_normal(100)
    camera = ScaledOrthographicCamera.look(yaw=10)
    fit = fit_3dmm(None, camera.project(ict.vertices(truth)[ict.landmarks]), model=ict)
    assert fit.report.rms_percent < 1.5 and abs(fit.camera.yaw - 10) < 3


def test_another_archive_is_refused(tmp_path):
    np.savez(tmp_path / "other.npz", neutral=np.zeros((5, 3)))
    with pytest.raises(ValueError, match="path: expected an archive of ICT-FaceKit, got no .*'landmarks68'"):
        load_ict_facekit(tmp_path / "other.npz")


def test_another_topology_is_refused(path, tmp_path):
    with np.load(path) as z:
        arrays = {name: z[name] for name in z.files}
    np.savez(tmp_path / "cut.npz", **{**arrays, "neutral": arrays["neutral"][:100]})
    with pytest.raises(ValueError, match="quads: expected|identity_q: expected"):
        load_ict_facekit(tmp_path / "cut.npz")


def test_the_published_folder_is_the_archive(shared, ict, tmp_path):
    folder = shared / "data" / "models" / "ict_facekit"
    model = load_model(folder / "FaceXModel", cache=tmp_path / "cache.npz")
    assert (tmp_path / "cache.npz").is_file() and model.expression_names == (
        "eyeBlinkLeft",
        "jawOpen",
        "mouthSmileRight",
    )
    np.testing.assert_allclose(model.mean, ict.mean, atol=2e-4)
    np.testing.assert_array_equal(model.faces, ict.faces)
    np.testing.assert_array_equal(model.quads, ict.quads)
    np.testing.assert_array_equal(model.landmarks, ict.landmarks)
    np.testing.assert_allclose(model.identity, ict.identity[:4], atol=2e-3)
    for name, shape in zip(model.expression_names, model.expression, strict=True):
        np.testing.assert_allclose(shape, ict.expression[ict.expression_index(name)], atol=2e-3)
    again = load_model(folder, cache=tmp_path / "cache.npz")
    np.testing.assert_array_equal(again.identity, model.identity)
    bare = load_model(folder)  # without a cache nothing is written
    np.testing.assert_allclose(bare.identity, model.identity, atol=2e-3)


def test_a_folder_that_does_not_fit_is_refused(shared, tmp_path):
    source = shared / "data" / "models" / "ict_facekit" / "FaceXModel"
    with pytest.raises(ValueError, match=r"expected generic_neutral_mesh.obj in it"):
        load_model(tmp_path, format="ict")
    for name in ("generic_neutral_mesh.obj", "vertex_indices.json"):
        (tmp_path / name).write_bytes((source / name).read_bytes())
    (tmp_path / "jawOpen.obj").write_text("v 0 0 0\nv 1 2 3\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(ValueError, match="jawOpen.obj: expected 26719 vertices as of the neutral face, got 3"):
        load_model(tmp_path)
    (tmp_path / "jawOpen.obj").write_text("v 0 0\n")
    with pytest.raises(ValueError, match=r"expected 3 coordinates"):
        load_model(tmp_path)
