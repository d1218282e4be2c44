import numpy as np
import pytest

from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera

ROTATION = ScaledOrthographicCamera.look(25.0, -15.0, 40.0).rotation


@pytest.fixture
def camera():
    return PerspectiveCamera(700.0, ROTATION, [20.0, -30.0, -600.0], [310.0, 250.0])


def points(count=50):
    return np.random.default_rng(0).normal(scale=80.0, size=(count, 3))


def test_projection_is_the_documented_formula(camera):
    for v, px in zip(points(), camera.project(points()), strict=True):
        x, y, z = camera.rotation @ v + camera.translation
        np.testing.assert_allclose(px, [310 + 700 * x / -z, 250 - 700 * y / -z], atol=1e-9)


def test_unproject_inverts_project_and_depth(camera):
    V = points()
    np.testing.assert_allclose(camera.unproject(camera.project(V), camera.depth(V)), V, atol=1e-10)
    px = np.random.default_rng(1).uniform(-50, 500, (20, 2))
    back = camera.unproject(px, -512.5)
    np.testing.assert_allclose(camera.project(back), px, atol=1e-9)
    np.testing.assert_allclose(camera.depth(back), -512.5, atol=1e-9)


def test_view_is_rigid_and_holds_depth(camera):
    V = points()
    seen = camera.view(V)
    np.testing.assert_allclose(seen[:, 2], camera.depth(V), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(seen - camera.translation, axis=1), np.linalg.norm(V, axis=1), rtol=1e-13)


def test_jacobian_is_the_derivative_of_the_pixels(camera):
    V = points()
    for k, step in enumerate(1e-3 * np.eye(3)):
        difference = (camera.project(V + step) - camera.project(V - step)) / 2e-3
        np.testing.assert_allclose(camera.jacobian(V)[:, :, k], difference, atol=1e-7)


def test_far_away_it_is_the_scaled_orthographic_camera():
    flat = ScaledOrthographicCamera(1.7, ROTATION, [100.0, 50.0])
    errors = []
    for distance in (1e4, 1e5):
        far = PerspectiveCamera(1.7 * distance, ROTATION, [0.0, 0.0, -distance], [100.0, 50.0])
        errors.append(np.abs(far.project(points()) - flat.project(points())).max())
    assert errors[1] == pytest.approx(errors[0] / 10, rel=0.1)
    assert errors[1] < 1


def test_image_y_runs_down_and_nearer_is_larger():
    camera = PerspectiveCamera(500.0, np.eye(3), [0, 0, -600], [0, 0])
    low, high = camera.project([[0.0, 0.0, 0.0], [0.0, 10.0, 0.0]])
    assert high[1] < low[1]
    nose, nape = [[10.0, 0.0, 100.0], [10.0, 0.0, -100.0]]
    assert camera.depth([nose])[0] > camera.depth([nape])[0]
    assert camera.project([nose])[0, 0] > camera.project([nape])[0, 0]


def test_lines_stay_lines(camera):
    a, b = points(2)
    px = camera.project([a + s * (b - a) for s in (0.0, 0.3, 1.0)])
    assert abs(np.linalg.det(np.diff(px, axis=0))) < 1e-9 * np.linalg.norm(px[2] - px[0]) ** 2


def test_what_is_behind_the_viewer_has_no_pixel(camera):
    behind = camera.unproject([[0.0, 0.0]], -1.0) + 2 * camera.rotation[2]
    assert np.isnan(camera.project(behind)).all()
    assert np.isnan(camera.jacobian(behind)).any()


def test_angles_are_those_of_the_rotation(camera):
    np.testing.assert_allclose((camera.yaw, camera.pitch, camera.roll), (25.0, -15.0, 40.0), atol=1e-9)


def test_cropped_and_scaled_change_pixels_only(camera):
    V = points()
    np.testing.assert_allclose(
        camera.cropped([12, -7], 0.3).project(V), 0.3 * (camera.project(V) - [12, -7]), atol=1e-9
    )
    np.testing.assert_allclose(camera.scaled(3.0).project(V) + 0.5, 3.0 * (camera.project(V) + 0.5), atol=1e-9)
    np.testing.assert_array_equal(camera.scaled(3.0).view(V), camera.view(V))


def test_camera_is_a_read_only_copy(camera):
    for array in (camera.rotation, camera.translation, camera.principal_point):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 2.0
    with pytest.raises(AttributeError, match="cannot assign"):
        camera.focal_px = 2.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"focal_px": 0.0}, "focal_px: expected a finite number > 0"),
        ({"focal_px": np.nan}, "focal_px: expected a finite number > 0"),
        ({"rotation": np.eye(2)}, r"rotation: expected a finite \(3, 3\)"),
        ({"rotation": 2.0 * np.eye(3)}, "rotation: expected an orthonormal"),
        ({"translation": [0, 0]}, r"translation: expected 3 finite numbers \(x, y, z\) in mm"),
        ({"translation": [0, 0, np.inf]}, "translation: expected 3 finite"),
        ({"translation": [0, 0, 5]}, "translation: expected z < 0, the model before the viewer, got 5.0"),
        ({"principal_point": [0, 0, 0]}, "principal_point: expected 2 finite"),
    ],
)
def test_bad_cameras(change, message):
    good = {"focal_px": 1.0, "rotation": np.eye(3), "translation": [0, 0, -1], "principal_point": [0, 0]}
    with pytest.raises(ValueError, match=message):
        PerspectiveCamera(**{**good, **change})


def test_bad_points(camera):
    with pytest.raises(ValueError, match=r"points: expected shape \(k, 3\)"):
        camera.project(np.zeros((4, 2)))
    with pytest.raises(ValueError, match=r"px: expected shape \(k, 2\)"):
        camera.unproject(np.zeros((4, 3)), -1.0)
    with pytest.raises(ValueError, match=r"depth: expected shape \(4,\)"):
        camera.unproject(np.zeros((4, 2)), np.zeros(3))
    with pytest.raises(ValueError, match="factor: expected"):
        camera.scaled(-1.0)
