import numpy as np
import pytest

from toongeo.caricature.blendshapes.landmark_mapper import PartMapper
from toongeo.caricature.blendshapes.sparse_expression import sparse_expression
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.render.camera import ScaledOrthographicCamera

CAMERA = ScaledOrthographicCamera.look(yaw=8.0, size=512)


@pytest.fixture(scope="module")
def mapper(model):
    return PartMapper(model)


@pytest.fixture(scope="module")
def smiling(model):
    """Coefficients of a smile, and a person."""
    expression = np.zeros(len(model.expression))
    for side in ("Left", "Right"):
        expression[model.expression_index(f"mouthSmile{side}")] = 0.7
    return np.random.default_rng(3).standard_normal(len(model.identity)) + model.prior.mean, expression


def landmarks(model, identity, expression):
    return CAMERA.project(model.vertices(identity, expression)[model.landmarks])


@pytest.mark.parametrize("name", ["bad_guy", "blue_girl", "astronaut"])
def test_a_drawing_comes_back_exactly(mapper, cartoon, name):
    drawn = cartoon(name)[1]
    normal, context = mapper.to_normal(drawn)
    np.testing.assert_allclose(mapper.to_caricature(normal, context), drawn, atol=1e-9)


def test_missing_landmarks_are_filled_in_and_the_others_come_back(mapper, cartoon):
    drawn = cartoon("astronaut")[1].copy()
    complete = drawn.copy()
    drawn[[3, 30, 41]] = np.nan
    normal, context = mapper.to_normal(drawn)
    back = mapper.to_caricature(normal, context)
    seen = np.isfinite(drawn).all(1)
    np.testing.assert_allclose(back[seen], drawn[seen], atol=1e-9)
    assert np.abs(back - complete).max() < 0.2 * np.linalg.norm(complete[36] - complete[45])


def test_scale_and_place_of_the_picture_change_nothing(mapper, cartoon):
    drawn = cartoon("blue_girl")[1]
    normal, context = mapper.to_normal(drawn)
    larger, other = mapper.to_normal(2 * drawn + [30, 50])
    np.testing.assert_allclose(larger, 2 * normal + [30, 50], atol=0.3)  # where the fit stops
    moved = normal + np.random.default_rng(0).normal(0, 1, (68, 2))
    np.testing.assert_allclose(
        mapper.to_caricature(2 * moved + [30, 50], other), 2 * mapper.to_caricature(moved, context) + [30, 50], atol=0.5
    )


def test_parts_that_the_normal_face_does_not_move_stay(mapper, cartoon):
    """Identity: eyes that move leave nose, mouth and outline of the drawing where they are."""
    normal, context = mapper.to_normal(cartoon("bad_guy")[1])
    moved = normal.copy()
    moved[PARTS["eye_left"]] += [1.0, 2.0]
    back = mapper.to_caricature(moved, context)
    others = np.setdiff1d(np.arange(68), PARTS["eye_left"])
    np.testing.assert_allclose(back[others], context.drawn[others], atol=1e-9)


def test_a_mouth_drawn_wider_opens_more_widely(mapper, model, smiling):
    plain = landmarks(model, smiling[0], np.zeros(len(model.expression)))
    centre, gaps = plain[PARTS["mouth"]].mean(0), []
    for growth in (1.0, 2.0, 3.0):
        drawn = plain.copy()
        drawn[PARTS["mouth"]] = centre + growth * (plain[PARTS["mouth"]] - centre)
        normal, context = mapper.to_normal(drawn)
        moved = normal.copy()
        moved[PARTS["mouth"][[17, 18, 19, 7, 8, 9]]] += [0.0, 10.0]  # the lower lip
        gaps.append(mapper.to_caricature(moved, context)[66, 1] - drawn[66, 1])
    assert gaps[0] == pytest.approx(10, rel=0.02)
    assert 1.05 * gaps[0] < gaps[1] < gaps[2] < 3 * gaps[0] and gaps[2] > 1.2 * gaps[0]


def test_lids_meet_and_do_not_cross(mapper, cartoon):
    normal, context = mapper.to_normal(cartoon("bad_guy")[1])
    closed = normal.copy()
    upper, lower = PARTS["eye_left"][[1, 2]], PARTS["eye_left"][[5, 4]]
    closed[upper] = 2 * normal[lower] - normal[upper]  # far beyond the lower lid
    back = mapper.to_caricature(closed, context)
    across = context.drawn[45] - context.drawn[42]
    down = np.array([-across[1], across[0]])
    assert ((back[lower] - back[upper]) @ down > -1e-9).all()


def test_a_caricature_keeps_the_expression_of_its_subject(mapper, model, smiling, face_space):
    """F+ carries information: a smile is told from a wide mouth (the experiment is in the benchmarks)."""
    identity, expression = smiling
    space, at = face_space.space, face_space.vertices
    own = space.fit(model.vertices(identity)[at], ridge=1e-2, iterations=5).w
    shape = model.vertices(identity, expression)[at]
    drawn = CAMERA.project((shape + space.vertices(2 * own) - space.vertices(own))[face_space.rows(model.landmarks)])
    normal, _ = mapper.to_normal(drawn)
    found = sparse_expression(fit_3dmm(None, normal, prior_weight=1e-6), normal).expression
    for side in ("Left", "Right"):
        assert 0.35 < found[model.expression_index(f"mouthSmile{side}")] < 1.0
    quiet = [model.expression_index(name) for name in ("jawOpen", "mouthPucker", "mouthFunnel")]
    assert found[quiet].max() < 0.3


def test_an_expression_within_the_model_is_found(model, smiling):
    points = landmarks(model, *smiling)
    found = sparse_expression(fit_3dmm(None, points), points)
    assert np.abs(found.expression - smiling[1])[: model.n_named].sum() < 1.5
    assert found.expression.min() > -3 - 1e-9 and found.expression[: model.n_named].min() >= 0


def test_bad_input_is_refused(mapper, model, cartoon):
    drawn = cartoon("blue_girl")[1]
    with pytest.raises(ValueError, match="landmarks: expected 68 points in iBUG order"):
        mapper.to_normal(drawn[:67])
    normal, context = mapper.to_normal(drawn)
    normal[5] = np.nan
    with pytest.raises(ValueError, match="normal: expected 68 landmarks, none of them missing, got NaN"):
        mapper.to_caricature(normal, context)
    with pytest.raises(ValueError, match="spread: expected a finite number > 0, got 0"):
        sparse_expression(fit_3dmm(None, drawn, model=model), drawn, spread=0)
