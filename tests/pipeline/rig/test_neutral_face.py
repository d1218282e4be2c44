"""The expression of a picture: taken out of the neutral face, and kept as a pose."""

import dataclasses

import numpy as np
import pytest

from toongeo import build_rig, make_avatar, neutral_face
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.lips_apart import lips_apart
from toongeo.model.expression_features import FEATURE_OF, FEATURES, REMOVED, SIGNS
from toongeo.pipeline.rig.fit_pose import fit_pose

SMILE = {"mouthSmileLeft": 0.9, "mouthSmileRight": 0.8, "jawOpen": 0.5, "mouthUpperUpLeft": 0.2, "eyeWideLeft": 0.9}


def posed(face, weights):
    """The face of the model itself with an expression: its neutral is known."""
    model = face.model
    expression = np.zeros(len(model.expression))
    for name, weight in weights.items():
        expression[model.expression_index(name)] = weight
    fit = dataclasses.replace(face.fit, expression=expression)
    return dataclasses.replace(face, fit=fit, vertices=fit.vertices)


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("moustache_man")


def lip_gap(model, V):
    """Distances of the inner lips (61-67, 62-66, 63-65)."""
    return np.linalg.norm(V[model.landmarks[[61, 62, 63]]] - V[model.landmarks[[67, 66, 65]]], axis=1)


def test_the_tables_speak_of_our_expressions(model):
    names = set(model.expression_names[: model.n_named])
    assert names > REMOVED and set(FEATURE_OF) < names and set(FEATURE_OF.values()) == set(FEATURES)
    assert set().union(*SIGNS.values()) <= REMOVED


def without_cavity(face):
    """The same face of a model that does not tell where the lips end."""
    regions = {name: mask for name, mask in face.model.regions.items() if name != "mouth_cavity"}
    return dataclasses.replace(face, model=dataclasses.replace(face.model, regions=regions))


def test_an_open_jaw_of_the_model_is_closed(face, model):
    """The lips meet between where they were, nearer to the upper one, and no opening expression is left."""
    opened = posed(face, {"jawOpen": 0.5})
    neutral = neutral_face(opened)
    np.testing.assert_array_equal(neutral.fit.expression, 0)
    assert lips_apart(model, neutral.vertices) < 0.02 < 0.1 < lips_apart(model, opened.vertices)
    upper, lower = (V[model.landmarks[[62, 66]], 1] for V in (opened.vertices, neutral.vertices))
    assert upper[0] >= lower[0] > upper.mean()
    assert lower[0] == pytest.approx(lower[1], abs=0.02 * np.ptp(upper))


def test_a_smile_stays(face, model):
    """What a fit calls a smile is often the face: only the opening is taken back, and the corners stay up."""
    smile = {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8}
    shut = posed(face, smile)
    neutral = neutral_face(posed(face, {**smile, "jawOpen": 0.5}))
    assert neutral_face(shut) is shut
    corners = model.landmarks[[48, 54]]
    wide = np.ptp(neutral.vertices[corners, 0]) / np.ptp(face.fit.model.mean[corners, 0])
    assert wide > 1.1
    assert neutral.fit.expression[model.expression_index("mouthSmileLeft")] == 0.8


def test_closing_leaves_alone_what_no_jaw_moves(face):
    opened = posed(face, SMILE)
    moved = np.linalg.norm(neutral_face(opened).vertices - opened.vertices, axis=1)
    for part in ("nose", "eye_left", "eye_right", "forehead", "ears"):
        assert moved[face.region(part)].max() == 0, part


@pytest.mark.parametrize("name", ["astronaut", "manga_girl"])
def test_a_mouth_that_is_drawn_open_closes_without_crossing(aligned, name, model):
    drawn = aligned(name)
    neutral = neutral_face(drawn)
    assert lips_apart(model, neutral.vertices) < 0.02 < lips_apart(model, drawn.vertices)
    F = model.faces[model.region("face")[model.faces].all(1)]
    crossings = [len(mesh_quality(V, F).intersecting) for V in (drawn.vertices, neutral.vertices)]
    assert crossings[1] <= crossings[0]


def test_a_smile_of_a_model_without_a_mouth_is_taken_out_to_its_neutral_face(face, model):
    """Where the aligned face is the fitted one, what inverse transfer must give is known: the model without it."""
    neutral = neutral_face(without_cavity(posed(face, SMILE)))
    expected = posed(face, {"eyeWideLeft": 0.9})
    skin = face.region("face")
    moved = np.linalg.norm(posed(face, SMILE).vertices - expected.vertices, axis=1)[skin]
    error = np.linalg.norm(neutral.vertices - expected.vertices, axis=1)[skin]
    assert np.sqrt((error**2).mean()) < 0.02 * np.sqrt((moved**2).mean())
    np.testing.assert_array_equal(neutral.fit.expression, expected.fit.expression)
    np.testing.assert_allclose(lip_gap(model, neutral.vertices), lip_gap(model, expected.vertices), atol=0.05)


@pytest.mark.parametrize("weights", [{}, {"mouthSmileLeft": 0.5, "jawOpen": 0.02}, {"eyeWideLeft": 1, "jawLeft": 0.5}])
def test_what_may_be_the_face_itself_is_left_in_it(face, weights):
    for same in (posed(face, weights), without_cavity(posed(face, weights))):
        assert neutral_face(same) is same


@pytest.mark.parametrize("weight", [0.03, 0.05, 0.1, 0.3])
def test_closing_knows_no_jump(face, weight):
    """A little more of an open mouth takes a little more closing."""
    less, more = (neutral_face(posed(face, {"jawOpen": w, "mouthSmileLeft": w})) for w in (weight, weight + 1e-3))
    assert np.abs(less.vertices - more.vertices)[face.region("face")].max() < 0.3


def test_parted_lips_meet_even_if_the_fit_knows_no_expression(face, model):
    """What the alignment has opened: the lower lip drawn down, as drawings open mouths."""
    neutral = posed(face, {})
    V = neutral.vertices.copy()
    lip = V[model.landmarks[66]]
    below = np.exp(-(np.linalg.norm(V - lip, axis=1) ** 2) / 300)
    V[:, 1] -= 20 * below * (model.region("lip_lower") | model.region("jaw"))
    parted = dataclasses.replace(neutral, vertices=V)
    assert lip_gap(model, parted.vertices)[1] > 10
    assert lip_gap(model, neutral_face(parted).vertices)[1] < 0.25 * lip_gap(model, parted.vertices)[1]


def test_a_model_without_these_expressions_is_left_alone(face, model):
    other = dataclasses.replace(model, expression_names=tuple(f"mode{k}" for k in range(64)))
    foreign = dataclasses.replace(posed(face, SMILE), model=other)
    assert neutral_face(foreign) is foreign


def test_the_pose_of_a_rigs_own_face_is_its_weights(face, rng):
    rig = build_rig(face)
    weights = rng.random(46) * (rng.random(46) < 0.3)
    found = fit_pose(rig, rig.vertices(weights), face.region("skin"))
    shown = rig.vertices(found) - rig.vertices(weights)
    assert np.abs(shown[face.region("skin")]).max() < 0.05
    np.testing.assert_allclose(found, weights, atol=0.03)
    np.testing.assert_array_equal(fit_pose(rig, rig.neutral, face.region("skin")), 0)


def test_a_pose_stays_within_its_bounds(face):
    rig = build_rig(face)
    beyond = fit_pose(rig, rig.vertices({"jawOpen": 1.7, "mouthSmileLeft": -0.5}), face.region("skin"))
    assert beyond.min() >= 0 and beyond.max() <= 1 and beyond[rig.names.index("jawOpen")] > 0.99


def test_a_pose_of_another_mesh_is_refused(face):
    with pytest.raises(ValueError, match=r"vertices: expected shape \(\d+, 3\) as the rig has, got \(5, 3\)"):
        fit_pose(build_rig(face), np.zeros((5, 3)), np.ones(5, bool))


def test_the_avatar_is_at_rest_and_its_pose_is_the_picture(cartoon, avatars, model):
    """The astronaut smiles: the neutral face has its mouth shut, the pose brings back the face of the picture."""
    smiling = avatars("astronaut")
    skin = smiling.face.region("face")
    motion = np.linalg.norm(smiling.face.vertices - smiling.vertices(), axis=1)[skin]
    left = np.linalg.norm(smiling.face.vertices - smiling.vertices(smiling.rig.pose), axis=1)[skin]
    assert np.sqrt((left**2).mean()) < 0.2 * np.sqrt((motion**2).mean())
    assert lip_gap(model, smiling.vertices())[1] < 0.2 * lip_gap(model, smiling.face.vertices)[1]
    assert 100 * smiling.report.aligned["inner51"] <= 0.1  # the face of the picture still meets the landmarks
    as_drawn = make_avatar(*cartoon("astronaut"), texture_size=64, neutral=False)
    np.testing.assert_array_equal(as_drawn.vertices(), as_drawn.face.vertices)
    np.testing.assert_array_equal(as_drawn.rig.pose, 0)
