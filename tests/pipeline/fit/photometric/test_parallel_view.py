"""A picture in perspective, resampled to a parallel view of the same head."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.photometric.parallel_view import in_perspective, parallel_view
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera, Surface, render_mesh, studio_light

SIZE = 320


@pytest.fixture(scope="module")
def near(model):
    """A head from half a metre, its picture and its landmarks."""
    rotation = ScaledOrthographicCamera.look(yaw=20, pitch=-5).rotation
    camera = PerspectiveCamera(750.0, rotation, [8.0, 12.0, -500.0], [150.0, 170.0])
    face = model.vertices(model.prior.mean)
    picture = render(model, face, camera)
    return camera, face, picture, camera.project(face[model.landmarks])


def render(model, face, camera):
    surface = Surface(face, model.faces, colours=model.albedo_mean)
    return render_mesh(surface, camera, SIZE, light=studio_light())


@pytest.fixture(scope="module")
def fit(model, near):
    camera, _, picture, landmarks = near
    found = fit_3dmm(picture, landmarks, camera="perspective", focal_px=750.0, principal_point=(150.0, 170.0))
    return replace(
        found,
        identity=model.prior.mean,
        expression=np.zeros(len(model.expression)),
        camera=camera,
        landmark_vertices=model.landmarks,
    )


def test_it_is_what_a_far_viewer_sees(model, near, fit):
    camera, face, picture, landmarks = near
    view = parallel_view(picture, None, landmarks, fit)
    far = view.fit.camera
    assert isinstance(far, ScaledOrthographicCamera) and view.confidence is None
    np.testing.assert_allclose(far.project(np.zeros((1, 3))), camera.project(np.zeros((1, 3))))
    np.testing.assert_allclose(view.pixels, far.project(face[model.landmarks]), atol=1e-9)
    expected = render(model, face, far).astype(float)
    skin = np.zeros((SIZE, SIZE), bool)
    inside = model.region("face") & (model.mean[:, 2] > 0)
    x, y = far.project(face[inside]).round().astype(int).T
    skin[y, x] = True
    away = [np.abs(image[skin].astype(float) - expected[skin]).mean() for image in (view.img, picture)]
    assert away[0] < 0.25 * away[1] and away[0] < 4


def test_missing_points_stay_missing_and_confidence_comes_along(near, fit):
    _, _, picture, landmarks = near
    gone = landmarks.copy()
    gone[5] = np.nan
    view = parallel_view(picture, np.ones((SIZE, SIZE), np.float32), gone, fit)
    assert np.isnan(view.pixels[5]).all() and np.isfinite(np.delete(view.pixels, 5, axis=0)).all()
    assert view.confidence.shape == (SIZE, SIZE) and view.confidence[150:170, 140:160].min() == 1


def test_a_parallel_camera_has_nothing_to_resample(near, fit):
    _, _, picture, landmarks = near
    orthographic = replace(fit, camera=ScaledOrthographicCamera.look(size=SIZE))
    view = parallel_view(picture, None, landmarks, orthographic)
    assert view.img is picture and view.fit is orthographic
    assert in_perspective(orthographic.camera, orthographic.camera) is orthographic.camera


def test_the_lens_comes_back(near, fit):
    camera, _, picture, landmarks = near
    back = in_perspective(parallel_view(picture, None, landmarks, fit).fit.camera, camera)
    np.testing.assert_allclose(back.translation, camera.translation, atol=1e-9)
    np.testing.assert_allclose(back.rotation, camera.rotation)
    assert (back.focal_px, *back.principal_point) == (750.0, 150.0, 170.0)


def test_a_photometric_fit_in_perspective_meets_the_picture(model, near):
    """From landmarks that are a little off."""
    camera, face, picture, landmarks = near
    noisy = landmarks + np.random.default_rng(1).normal(0, 1.0, (68, 2))
    lens = {"camera": "perspective", "focal_px": 750.0, "principal_point": (150.0, 170.0)}
    found = fit_3dmm(picture, noisy, photometric=True, **lens)
    start = fit_3dmm(picture, noisy, **lens)
    assert isinstance(found.camera, PerspectiveCamera) and found.camera.focal_px == 750.0
    assert found.photometric.residual_after < found.photometric.residual_before
    skin = model.region("face")
    off = [
        np.linalg.norm(each.project(each.vertices) - camera.project(face), axis=1)[skin].mean()
        for each in (start, found)
    ]
    assert off[1] < off[0]
