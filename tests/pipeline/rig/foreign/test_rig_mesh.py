"""Foreign heads: the model's own mesh gets its own expressions, and others get them nearly."""

import dataclasses
import importlib.util
from pathlib import Path

import numpy as np
import pytest

from toongeo.model.anatomy.rims import rim_path
from toongeo.model.ibug68 import INNER, MIRROR
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit
from toongeo.pipeline.rig.foreign.check_winding import check_winding
from toongeo.pipeline.rig.foreign.close_gaps import _heights
from toongeo.pipeline.rig.foreign.rig_mesh import rig_mesh

SHIFT = np.array([3.0, -2.0, 9.0])


@pytest.fixture(scope="module")
def turn():
    Q, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    return Q * np.sign(np.linalg.det(Q))


@pytest.fixture(scope="module")
def shuffled(model, turn):
    """The model's own mean, its vertices in another order, turned, shrunk and moved; with eyeballs of its own."""
    order = np.random.default_rng(0).permutation(len(model.mean))
    place = np.argsort(order)
    V, F = model.mean[order], place[model.faces]
    for eye in model.eyes:
        F = np.vstack([F, eye.faces + len(V)])
        V = np.vstack([V, eye.centre + eye.radius * eye.vertices])
    V = 0.01 * V @ turn.T + SHIFT
    points = V[place[model.landmarks]]
    points[:17] = np.nan
    return order, points, rig_mesh(V, F, points)


@pytest.fixture(scope="module")
def ict(shared):
    return load_ict_facekit(shared / "data" / "models" / "ict_facekit" / "ict_facekit_light.npz")


@pytest.fixture(scope="module")
def ict_rig(ict):
    return rig_mesh(ict.mean, ict.faces, ict.landmarks)


def test_the_models_own_mesh_gets_its_own_expressions(model, shuffled, turn):
    order, _, rig = shuffled
    n = len(order)
    expected = model.expression[: model.n_named, order]
    found = rig.deltas[:, :n] @ turn / 0.01
    assert rig.names == model.expression_names[: model.n_named]
    skin = (model.region("skin") | model.region("neck"))[order]
    np.testing.assert_allclose(found[:, skin], expected[:, skin], atol=0.05)  # mm; what hardly moves is held
    error, motion = (np.linalg.norm(x, axis=2).sum(1) for x in (found - expected, expected))
    assert (error < 0.25 * motion).all()  # with the inside of the mouth, which is not looked for


def test_eyeballs_stay(shuffled):
    order, _, rig = shuffled
    assert not rig.deltas[:, len(order) :].any()


def test_the_rig_is_in_the_frame_of_the_mesh(shuffled):
    _, points, rig = shuffled
    moved = np.linalg.norm(rig.vertices({"jawOpen": 1.0}) - rig.neutral, axis=1).max()
    size = np.linalg.norm(points[36] - points[45])
    assert 0.2 * size < moved < size
    np.testing.assert_array_equal(rig.vertices(), rig.neutral)


@pytest.mark.slow
def test_there_and_back_all_expressions_return(model, ict):
    spec = importlib.util.spec_from_file_location("register", Path(__file__).parents[4] / "benchmarks" / "register.py")
    benchmark = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(benchmark)
    errors = benchmark.relative_errors(model, benchmark.round_trip(model, ict))
    unknown = [name for name, error in zip(model.expression_names, errors, strict=False) if np.isnan(error)]
    assert unknown == ["tongueOut"]  # this head has no tongue
    assert np.nanmax(errors) <= 0.15


def test_upper_lips_and_lids_move_as_upper_ones(model, ict, ict_rig):
    """Every landmark of another head moves as the template's, in direction and about in length."""
    size = np.linalg.norm(ict.mean[ict.landmarks[45]] - ict.mean[ict.landmarks[36]]) / np.linalg.norm(
        model.mean[model.landmarks[45]] - model.mean[model.landmarks[36]]
    )
    for name in ("jawOpen", "mouthUpperUpLeft", "mouthLowerDownRight", "mouthShrugLower", "eyeBlinkRight"):
        k = ict_rig.names.index(name)
        found, expected = ict_rig.deltas[k, ict.landmarks[INNER]], size * model.expression[k, model.landmarks[INNER]]
        assert np.linalg.norm(found - expected, axis=1).max() < 0.35 * np.linalg.norm(expected, axis=1).max()


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_blink_closes_the_eyes_of_another_head(ict, ict_rig, side):
    closed = ict_rig.vertices({f"eyeBlink{side.capitalize()}": 1.0})
    rims = [rim_path(ict, f"lid_{lid}_{side}") for lid in ("upper", "lower")]
    open_eye, closed_eye = (_heights(ict.mean, V, *rims)[0] for V in (ict.mean, closed))
    assert closed_eye.max() < 0.05 * open_eye.max()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"V": np.zeros((0, 3))}, "V: expected real numbers"),
        ({"F": [[0, 1, 10**6]]}, "F: expected indices in"),
        ({"landmarks": np.arange(67)}, "landmarks: expected 68 vertices or points .* got 67"),
        ({"landmarks": np.full(68, -1)}, "landmarks: expected vertex indices in"),
        ({"landmarks": np.full((68, 3), np.nan)}, "landmarks: expected at least 12 of the points 17-67, got 0"),
        ({"landmarks": np.full((68, 2), 1.0)}, r"landmarks: expected vertex indices \(k,\) or points \(k, 3\)"),
        ({"landmarks": np.full((68, 3), np.inf)}, "landmarks: expected finite coordinates or NaN"),
        ({"landmarks": np.zeros(68, int)}, "landmarks: expected the points of a face, got one place for all"),
        ({"landmarks": np.arange(68) * 250}, "landmarks: expected the points of a face in the order of iBUG-68"),
    ],
)
def test_bad_input_is_named(model, change, message):
    arguments = {"V": model.mean, "F": model.faces, "landmarks": model.landmarks, **change}
    with pytest.raises(ValueError, match=message):
        rig_mesh(**arguments)


def test_a_model_without_expressions_is_refused(model):
    still = dataclasses.replace(model, n_named=0)
    with pytest.raises(ValueError, match="model: expected one with named expressions, got one without"):
        rig_mesh(model.mean, model.faces, model.landmarks, model=still)


def test_a_head_that_is_inside_out_is_refused(model, monkeypatch):
    front = model.faces[model.region("face")[model.faces].all(1)]
    monkeypatch.setattr("toongeo.pipeline.rig.foreign.rig_mesh.register_face", pytest.fail)  # before the long part
    for turned in (np.eye(3), np.diag([-1.0, 1.0, -1.0])):  # seen from the front and from behind
        with pytest.raises(
            ValueError, match=r"F: expected triangles counter-clockwise from outside, .* of 51 landmarks"
        ):
            rig_mesh(model.mean @ turned, front[:, ::-1], model.landmarks)
        check_winding(model.mean @ turned, front, model.mean[model.landmarks] @ turned, model)


@pytest.mark.slow
def test_a_model_without_eyes_will_do(model):
    """A front of the face alone, rigged by a model that has no regions but the front."""
    small = dataclasses.replace(
        model, regions={k: model.regions[k] for k in ("face", "mouth", "eye_left", "eye_right")}
    )
    front = model.faces[model.region("face")[model.faces].all(1)]
    rig = rig_mesh(model.mean, front, model.landmarks, model=small)
    unused = np.setdiff1d(np.arange(len(model.mean)), front)
    assert not rig.deltas[:, unused].any() and rig.report.partnered > 0.9


@pytest.mark.slow
def test_a_head_far_from_the_origin_keeps_its_rig(model):
    near = rig_mesh(model.mean, model.faces, model.landmarks)
    place = np.array([3e8, 5e9, 1e5])  # mm: a scan in the coordinates of a map
    far = rig_mesh(model.mean + place, model.faces, model.landmarks)
    apart = np.linalg.norm(far.deltas - near.deltas, axis=2)  # of what the digits that are left make of lips and lids
    assert apart.mean() < 0.01 and np.quantile(apart, 0.99) < 0.2 and apart.max() < 3
    np.testing.assert_array_equal(far.neutral, model.mean + place)


@pytest.mark.parametrize("mirrored", ["landmarks", "mesh"])
def test_exchanged_sides_are_refused(model, mirrored):
    V = model.mean * ([-1, 1, 1] if mirrored == "mesh" else 1)
    F = model.faces[:, ::-1] if mirrored == "mesh" else model.faces
    points = V[model.landmarks[MIRROR] if mirrored == "landmarks" else model.landmarks]
    with pytest.raises(ValueError, match="landmarks: left and right are exchanged, or the mesh is mirrored"):
        rig_mesh(V, F, points)
