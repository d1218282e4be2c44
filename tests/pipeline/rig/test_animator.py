import numpy as np
import pytest

from toongeo import Animator
from toongeo.geometry import vertex_normals
from toongeo.pipeline.rig.add_rows import add_rows


@pytest.fixture(scope="module")
def animator(avatar):
    return Animator(avatar)


@pytest.mark.parametrize("active", [0, 1, 7, 46])
def test_a_frame_is_the_face_of_the_rig(avatar, animator, rng, active):
    weights = np.zeros(54)
    weights[rng.choice(54, active, replace=False)] = rng.random(active)
    frame = animator.frame(weights)
    assert frame.dtype == np.float32
    np.testing.assert_allclose(frame, avatar.vertices(weights), atol=1e-4)
    for eye, side in zip(animator.eye_frames(weights), (0, 1), strict=True):
        np.testing.assert_array_equal(eye, avatar.eye_vertices(side, weights))


def test_names_are_those_of_the_weights(animator):
    for k in (0, 20, 45, 46, 53):
        np.testing.assert_array_equal(animator.frame({animator.names[k]: 0.4}), animator.frame(0.4 * np.eye(54)[k]))


def test_weights_are_clipped_unless_asked_otherwise(avatar, animator):
    too_much, full = {"jawOpen": 1.5, "jawLeft": -0.2, "eyeLookUpLeft": 3}, {"jawOpen": 1, "eyeLookUpLeft": 1}
    np.testing.assert_array_equal(animator.frame(too_much), animator.frame(full))
    np.testing.assert_array_equal(animator.eye_frames(too_much)[0], animator.eye_frames(full)[0])
    wide = Animator(avatar, limits=(0, 1.5))
    np.testing.assert_array_equal(wide.frame({"jawOpen": 1.7}), wide.frame({"jawOpen": 1.5}))
    free = Animator(avatar, limits=None)
    opened = free.frame({"jawOpen": -1}).astype(float) + free.frame({"jawOpen": 1})
    np.testing.assert_allclose(opened / 2, avatar.vertices(), atol=1e-4)


def test_a_buffer_is_filled_and_nothing_else(avatar, animator):
    out = np.full(avatar.vertices().shape, np.nan, np.float32)
    assert animator.frame({"jawOpen": 0.5}, out=out) is out
    np.testing.assert_array_equal(out, animator.frame({"jawOpen": 0.5}))
    animator.frame(out=out)
    np.testing.assert_array_equal(out, avatar.rig.neutral.astype(np.float32))


def test_normals_are_those_of_the_frame(animator):
    V = animator.frame({"mouthPucker": 1})
    np.testing.assert_array_equal(animator.normals(V), vertex_normals(V, animator.faces))


def test_few_and_many_rows_add_up_alike(rng):
    rows, weights = rng.normal(size=(20, 31)).astype(np.float32), rng.normal(size=20)
    for few in (0, 3, 12, 13, 20):
        some = weights * (np.arange(20) < few)
        total = np.ones(31, np.float32)
        add_rows(total, rows, some)
        np.testing.assert_allclose(total, 1 + some @ rows.astype(float), atol=1e-5)


def test_bad_arguments_are_named(avatar, animator):
    with pytest.raises(ValueError, match="weights: no expression 'jawOpne'; did you mean jawOpen"):
        animator.frame({"jawOpne": 1})
    with pytest.raises(ValueError, match="weights: expected 46 values, got shape"):
        animator.frame(np.zeros(47))
    with pytest.raises(ValueError, match="weights: expected finite values"):
        animator.frame(np.full(46, np.nan))
    for limits in ((1, 0), (0, np.inf), (1,), 3):
        with pytest.raises(ValueError, match=r"limits: expected \(low, high\)"):
            Animator(avatar, limits=limits)
    for out in (np.zeros((3, 3), np.float32), np.zeros(avatar.vertices().shape)):
        with pytest.raises(ValueError, match="out: expected contiguous writable float32"):
            animator.frame(out=out)
