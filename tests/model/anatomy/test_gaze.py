import numpy as np
import pytest

from toongeo.model.anatomy.gaze import TURN, gaze_names, gaze_rotation, gaze_weights


@pytest.mark.parametrize("side", ["left", "right"])
def test_no_weight_turns_nothing(side):
    np.testing.assert_allclose(gaze_rotation(side, {"jawOpen": 1.0}), np.eye(3), atol=1e-15)


@pytest.mark.parametrize(
    ("name", "axis", "sign"),
    [
        ("eyeLookInLeft", 0, -1),
        ("eyeLookOutLeft", 0, 1),
        ("eyeLookInRight", 0, 1),
        ("eyeLookOutRight", 0, -1),
        ("eyeLookUpLeft", 1, 1),
        ("eyeLookDownRight", 1, -1),
    ],
)
def test_each_name_turns_its_way(name, axis, sign):
    side = "left" if name.endswith("Left") else "right"
    look = gaze_rotation(side, {name: 1.0}) @ [0, 0, 1]
    assert np.sign(look[axis]) == sign
    assert look[1 - axis] == pytest.approx(0, abs=1e-15)


def test_the_eyes_are_mirror_images(rng):
    weights = rng.random(4)
    left = gaze_rotation("left", dict(zip(gaze_names("left"), weights, strict=True)))
    right = gaze_rotation("right", dict(zip(gaze_names("right"), weights, strict=True)))
    mirror = np.diag([-1, 1, 1])
    np.testing.assert_allclose(mirror @ left @ mirror, right, atol=1e-15)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("turn", [TURN, (12.0, 20.0)])
def test_the_weights_of_a_gaze_are_those_that_turn_there(side, turn, rng):
    for sideways, updown in rng.uniform(-1, 1, (50, 2)):
        pairs = zip(gaze_names(side), (-sideways, sideways, updown, -updown), strict=True)
        weights = {name: max(weight, 0.0) for name, weight in pairs}
        direction = gaze_rotation(side, weights, turn) @ [0, 0, rng.uniform(0.1, 10)]
        assert gaze_weights(side, direction, turn) == pytest.approx(weights, abs=1e-12)


def test_beyond_the_range_of_the_eye_the_weights_are_full():
    inward, outward, up, down = gaze_names("left")
    assert gaze_weights("left", np.array([1.0, 1.0, 0.1])) == {inward: 0, outward: 1, up: 1, down: 0}


def test_the_turn_scales_the_angle():
    look = gaze_rotation("left", {"eyeLookOutLeft": 0.5}, (40.0, 10.0)) @ [0, 0, 1]
    np.testing.assert_allclose(look, [np.sin(np.radians(20)), 0, np.cos(np.radians(20))], atol=1e-15)
    look = gaze_rotation("right", {"eyeLookUpRight": 1.0}, (40.0, 10.0)) @ [0, 0, 1]
    np.testing.assert_allclose(look, [0, np.sin(np.radians(10)), np.cos(np.radians(10))], atol=1e-15)
