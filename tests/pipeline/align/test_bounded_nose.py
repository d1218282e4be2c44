import numpy as np
import pytest

from toongeo.pipeline.align.bounded_nose import bounded_nose, protrusion
from toongeo.render import ScaledOrthographicCamera


def long_nosed(model, growth):
    """The mean face whose nose stands out so many times as far."""
    V = model.mean.copy()
    nose = model.region("nose")
    base = np.percentile(V[nose, 2], 10)
    V[nose, 2] += (growth - 1) * np.clip(V[nose, 2] - base, 0, None)
    return V


@pytest.fixture(scope="module")
def ahead():
    return ScaledOrthographicCamera.look(size=400)


def test_the_mean_nose_stays(model, ahead):
    assert bounded_nose(model, ahead, model.mean) is model.mean


def test_needles_become_noses_and_longer_ones_stay_longer(model, ahead):
    own = protrusion(model, model.mean)
    drawn = [long_nosed(model, growth) for growth in (1.4, 2.0, 4.0)]
    before = np.array([protrusion(model, V) for V in drawn]) / own
    after = np.array([protrusion(model, bounded_nose(model, ahead, V)) for V in drawn]) / own
    assert (after < before).all() and (np.diff(after) > 0).all() and after.max() < 1.6 < before.max()


@pytest.mark.parametrize("yaw", [0, 25])
def test_the_picture_of_the_nose_does_not_change(model, yaw):
    camera = ScaledOrthographicCamera.look(yaw=yaw, size=400)
    V = long_nosed(model, 3.0)
    bounded = bounded_nose(model, camera, V)
    np.testing.assert_allclose(camera.project(bounded), camera.project(V), atol=1e-9)
    np.testing.assert_array_equal(bounded[~model.region("nose")], V[~model.region("nose")])
    assert np.abs(bounded - V)[model.region("nose")].max() > 1


def test_the_nose_of_a_turned_head_is_not_bent_aside(model):
    """Seen from the side the picture tells how long it is; what is taken off would show as a bend from the front."""
    V = long_nosed(model, 4.0)
    breadth = np.linalg.norm(np.subtract(*V[model.landmarks[[0, 16]]]))
    moved = bounded_nose(model, ScaledOrthographicCamera.look(yaw=40), V) - V
    assert 0 < np.abs(moved[:, 0]).max() <= 0.031 * breadth


def test_a_face_and_its_mirror_image_keep_being_that(model, ahead):
    V = long_nosed(model, 2.5)
    mirrored = (V * [-1, 1, 1])[model.mirror]
    back = (bounded_nose(model, ahead, mirrored) * [-1, 1, 1])[model.mirror]
    np.testing.assert_allclose(back, bounded_nose(model, ahead, V), atol=1e-6)
