"""The people of a model on the template's surface."""

import numpy as np
import pytest

from toongeo.geometry.facing_surface import FacingSurface
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.model import MorphableModel, load_model, save_model


@pytest.fixture(scope="module")
def people(model):
    """Front of the template with another identity as its mean, ten modes, colours, and one expression of its own."""
    used, faces = np.unique(model.faces[model.region("face")[model.faces].all(1)], return_inverse=True)
    new = np.full(len(model.mean), -1)
    new[used] = np.arange(len(used))
    shift = np.random.default_rng(1).normal(0, 0.7, len(model.identity))
    jaw = model.landmarks.copy()
    jaw[:17] = model.landmarks[17]
    colour = np.random.default_rng(2).uniform(0.3, 0.7, (len(used), 3))
    return (
        MorphableModel.from_arrays(
            0.1 * model.vertices(shift)[used] + 7.0,
            faces.reshape(-1, 3),
            identity=0.1 * model.identity[:10, used],
            expression=0.1 * model.expression[60:61, used],
            landmarks=new[jaw],
            unit=10.0,
            albedo_mean=colour,
            albedo=0.05 * np.ones((1, len(used), 3)),
        ),
        shift,
    )


@pytest.fixture(scope="module")
def laid(people):
    return people[0].with_rig_of()


def test_it_has_all_that_the_template_has(model, laid, people):
    assert laid.has("eyes", "mouth_cavity", "teeth_upper", "tongue", "jawOpen", "uv", "quads", "contours", "albedo")
    np.testing.assert_array_equal(laid.faces, model.faces)
    assert len(laid.identity) == 10 and laid.n_named == 46 and len(laid.expression) == 47
    np.testing.assert_allclose(np.mean([eye.centre for eye in laid.eyes], axis=0), 0, atol=1e-9)


def test_its_face_lies_on_the_models(people, laid):
    person, _ = people
    front = laid.region("face")
    middle = person.mean[person.landmarks[17:]].mean(0) - laid.mean[laid.landmarks[17:]].mean(0)
    V = laid.mean + middle
    surface = FacingSurface(person.mean, person.faces)
    triangles, bary, _ = surface.closest(V[front], vertex_normals(V, laid.faces)[front])
    off = np.linalg.norm(surface.points(triangles, bary) - V[front], axis=1)
    assert np.median(off) < 0.2 and np.quantile(off, 0.95) < 1.0


def test_people_are_those_of_the_model(model, laid):
    """Correspondence slides a little; what a mode does to a place on the face does not depend on it."""
    front = model.region("face") & ~model.region("forehead")
    error = np.linalg.norm(laid.identity[:, front] - model.identity[:10, front], axis=2)
    size = np.linalg.norm(model.identity[:10, front], axis=2)
    assert error.mean() < 0.12 * size.mean()


def test_eyeballs_go_with_their_lids(model, laid, people):
    for side, eye in enumerate(laid.eyes):
        corners = laid.landmarks[[42, 45] if side == 0 else [36, 39]]
        ahead = laid.mean[corners].mean(0) - eye.centre
        assert 5 < ahead[2] < 20 and np.linalg.norm(ahead[:2]) < 5
        moved = laid.identity[:, corners].mean(1)
        np.testing.assert_allclose(eye.centre_modes, moved, atol=0.5 * np.abs(moved).max())


def test_named_expressions_do_what_they_are_called(model, laid):
    jaw = laid.expression[laid.expression_index("jawOpen")]
    assert jaw[laid.landmarks[57], 1] < -20 and abs(jaw[laid.landmarks[51], 1]) < 4
    blink = laid.expression[laid.expression_index("eyeBlinkLeft")]
    assert blink[laid.landmarks[44], 1] < -4 and np.abs(blink[laid.landmarks[37]]).max() < 0.5


def test_colours_come_along(laid):
    front = laid.region("face")
    assert abs(laid.albedo_mean[front].mean() - 0.5) < 0.03
    np.testing.assert_allclose(laid.albedo[0, front], 0.05, atol=1e-6)


def test_the_file_of_it_is_the_same(laid, tmp_path):
    save_model(laid, tmp_path / "laid.npz")
    again = load_model(tmp_path / "laid.npz")
    np.testing.assert_array_equal(again.identity, laid.identity)
    np.testing.assert_array_equal(again.eyes[1].centre_modes, laid.eyes[1].centre_modes)


def test_without_landmarks_there_is_no_way(model, people):
    person, _ = people
    with pytest.raises(ValueError, match="model: expected one with landmarks"):
        MorphableModel.from_arrays(person.mean, person.faces).with_rig_of()
    with pytest.raises(ValueError, match="template: expected a model with landmarks and named expressions"):
        person.with_rig_of(person)
    with pytest.raises(ValueError, match="vertices: expected 68 whole numbers"):
        person.with_landmarks(np.arange(5))
    with pytest.raises(ValueError, match="vertices: expected vertices in 0"):
        person.with_landmarks(np.arange(68) + len(person.mean))
