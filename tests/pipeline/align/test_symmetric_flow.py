import numpy as np
import pytest

from toongeo.geometry import self_intersections
from toongeo.model.anatomy.visible_contour import visible_contour
from toongeo.pipeline.align.symmetric_flow import symmetric_flow
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera

CAMERA = ScaledOrthographicCamera.look(yaw=20, pitch=5, size=512)
PERSPECTIVE = PerspectiveCamera(900.0, CAMERA.rotation, [0.0, 20.0, -500.0], [255.5, 255.5])


def flow(model, landmarks, camera=CAMERA, depth="scaled", slide=False):
    return symmetric_flow(model, camera, model.mean, model.landmarks, landmarks, depth, slide)


def exaggerated(model, camera=CAMERA):
    """Landmarks of a caricature: eyes and nose half as big again, jaw drawn in."""
    px = camera.project(model.mean[model.landmarks])
    for part, factor in ((slice(36, 42), 1.5), (slice(42, 48), 1.5), (slice(27, 36), 1.5), (slice(0, 17), 0.9)):
        px[part] = px[part].mean(0) + factor * (px[part] - px[part].mean(0))
    return px


def test_landmarks_that_are_met_move_nothing(model):
    V, at = flow(model, CAMERA.project(model.mean[model.landmarks]))
    np.testing.assert_allclose(V, model.mean, atol=1e-9)
    np.testing.assert_array_equal(at, model.landmarks)


@pytest.mark.parametrize("camera", [CAMERA, PERSPECTIVE], ids=["orthographic", "perspective"])
def test_the_landmarks_come_near(model, camera):
    wanted = exaggerated(model, camera)
    V, at = flow(model, wanted, camera)
    before, after = (np.linalg.norm(camera.project(X[at]) - wanted, axis=1).max() for X in (model.mean, V))
    assert after < 0.05 * before


def test_nothing_folds(model):
    V, _ = flow(model, exaggerated(model))
    front = model.faces[model.region("face")[model.faces].all(1)]
    crossing = np.unique(self_intersections(V, front))
    assert len(crossing) <= 0.0005 * len(front)


def test_depth_is_kept_or_follows(model):
    wanted = exaggerated(model)
    kept, scaled = (flow(model, wanted, depth=depth)[0] for depth in ("keep", "scaled"))
    np.testing.assert_allclose(CAMERA.depth(kept), CAMERA.depth(model.mean), atol=1e-9)
    nose = model.region("nose")
    relief = [np.ptp(CAMERA.depth(V[nose])) for V in (model.mean, kept, scaled)]
    assert relief[2] > 1.05 * relief[1] == pytest.approx(1.05 * relief[0])


def test_a_hidden_half_follows_the_seen_one(model):
    """Only the landmarks of the right half are given; those of the left grow alike."""
    camera = ScaledOrthographicCamera.look(size=512)
    wanted = exaggerated(model, camera)
    half = wanted.copy()
    half[42:48] = np.nan
    V, _ = flow(model, half, camera)
    before, after = (
        np.linalg.norm(camera.project(X[model.landmarks[42:48]]) - wanted[42:48], axis=1).mean()
        for X in (model.mean, V)
    )
    assert after < 0.3 * before


def test_jaw_points_slide_to_the_outline(model):
    """On the face they end on, few are off the outline, though those of the front view were."""
    camera = ScaledOrthographicCamera.look(yaw=35, size=512)
    at = visible_contour(model, camera, model.mean, model.landmarks)
    np.testing.assert_array_equal(visible_contour(model, camera, model.mean, at), at)
    np.testing.assert_array_equal(at[17:], model.landmarks[17:])
    assert (at[:17] != model.landmarks[:17]).sum() > 5
    for line, vertex in zip(model.contour_lines, at, strict=False):
        assert vertex in line
    _, slid = flow(model, camera.project(model.mean[at]), camera, slide=True)
    assert (slid[:17] != model.landmarks[:17]).sum() > 5


def test_same_input_same_output(model):
    wanted = exaggerated(model)
    np.testing.assert_array_equal(flow(model, wanted)[0], flow(model, wanted)[0])
