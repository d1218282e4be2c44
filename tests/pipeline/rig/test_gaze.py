import numpy as np
import pytest

from toongeo.pipeline.rig.gaze import gaze_names, gaze_rotation


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
