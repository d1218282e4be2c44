import numpy as np
import pytest

from toongeo.render import ScaledOrthographicCamera


@pytest.fixture
def camera():
    return ScaledOrthographicCamera.look(25.0, -15.0, 40.0, size=(300, 400), centre=(3.0, -20.0, 7.0), extent=250.0)


def points(count=50):
    return np.random.default_rng(0).normal(scale=80.0, size=(count, 3))


def test_projection_is_the_documented_formula(camera):
    P = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    expected = [camera.scale * P @ camera.rotation @ v + camera.translation for v in points()]
    np.testing.assert_allclose(camera.project(points()), expected, atol=1e-12 * 300)


def test_unproject_inverts_project_and_depth(camera):
    V = points()
    np.testing.assert_allclose(camera.unproject(camera.project(V), camera.depth(V)), V, atol=1e-11)
    px = np.random.default_rng(1).uniform(-50, 500, (20, 2))
    back = camera.unproject(px, 12.5)
    np.testing.assert_allclose(camera.project(back), px, atol=1e-10)
    np.testing.assert_allclose(camera.depth(back), 12.5, atol=1e-11)


def test_view_is_rigid_and_holds_depth(camera):
    V = points()
    seen = camera.view(V)
    np.testing.assert_allclose(seen[:, 2], camera.depth(V), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(seen, axis=1), np.linalg.norm(V, axis=1), rtol=1e-13)


def test_jacobian_is_the_derivative_of_the_pixels(camera):
    V = points()
    for k, step in enumerate(1e-3 * np.eye(3)):
        difference = (camera.project(V + step) - camera.project(V - step)) / 2e-3
        np.testing.assert_allclose(camera.jacobian(V)[:, :, k], difference, atol=1e-8)


def test_rotating_the_mesh_equals_rotating_the_camera(camera):
    turn = ScaledOrthographicCamera.look(10.0, 20.0, 30.0).rotation
    composed = ScaledOrthographicCamera(camera.scale, camera.rotation @ turn, camera.translation)
    np.testing.assert_allclose(composed.project(points()), camera.project(points() @ turn.T), atol=1e-10)


def test_image_y_runs_down_and_nearer_is_larger():
    camera = ScaledOrthographicCamera.look(size=100)
    low, high = camera.project([[0.0, 0.0, 0.0], [0.0, 10.0, 0.0]])
    assert high[1] < low[1]
    nose, nape = camera.depth([[0.0, 0.0, 100.0], [0.0, 0.0, -100.0]])
    assert nose > nape


def test_signs_of_the_angles():
    nose, crown = np.eye(3)[[2]] * 10.0, np.eye(3)[[1]] * 10.0
    assert ScaledOrthographicCamera.look(yaw=30.0).view(nose)[0, 0] > 0.0  # to the right of the image
    assert ScaledOrthographicCamera.look(pitch=30.0).view(nose)[0, 1] < 0.0  # down
    assert ScaledOrthographicCamera.look(pitch=30.0).depth(crown)[0] > 0.0  # the crown comes into view
    assert ScaledOrthographicCamera.look(roll=30.0).view(crown)[0, 0] < 0.0  # counter-clockwise


@pytest.mark.parametrize("angles", [(0, 0, 0), (30, 20, 10), (-120, -45, 170), (80, 89, -5)])
def test_angles_round_trip(angles):
    camera = ScaledOrthographicCamera.look(*angles)
    np.testing.assert_allclose((camera.yaw, camera.pitch, camera.roll), angles, atol=1e-9)


@pytest.mark.parametrize("size", [(101, 200), (200, 101), 64])
def test_look_puts_the_centre_in_the_middle_and_spans_the_extent(size):
    height, width = (size, size) if isinstance(size, int) else size
    camera = ScaledOrthographicCamera.look(35.0, -20.0, size=size, centre=(1.0, 2.0, 3.0), extent=200.0)
    np.testing.assert_allclose(camera.project([[1.0, 2.0, 3.0]])[0], [(width - 1) / 2, (height - 1) / 2])
    assert camera.scale == pytest.approx(min(height, width) / 200.0)


def test_scaled_keeps_the_area_of_every_pixel(camera):
    # pixel x covers [x - 1/2, x + 1/2]: its edges scale, its centre does not
    px, doubled = camera.project(points()), camera.scaled(3.0).project(points())
    np.testing.assert_allclose(doubled + 0.5, 3.0 * (px + 0.5), atol=1e-10)
    np.testing.assert_allclose(camera.scaled(3.0).scaled(1 / 3).project(points()), px, atol=1e-10)


def test_cropped_shifts_and_then_scales_pixels(camera):
    found = camera.cropped([12.0, -7.5], 0.3).project(points())
    np.testing.assert_allclose(found, 0.3 * (camera.project(points()) - [12.0, -7.5]), atol=1e-10)


def test_camera_is_read_only(camera):
    with pytest.raises(ValueError, match="read-only"):
        camera.rotation[0, 0] = 2.0
    with pytest.raises(AttributeError, match="cannot assign"):
        camera.scale = 2.0


def test_camera_copies_its_arrays():
    rotation = np.eye(3)
    camera = ScaledOrthographicCamera(1.0, rotation, np.zeros(2))
    rotation[0, 0] = 5.0
    assert camera.rotation[0, 0] == 1.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0, np.eye(3), [0, 0]), "scale: expected a finite number > 0"),
        ((np.nan, np.eye(3), [0, 0]), "scale: expected"),
        ((1.0, np.eye(2), [0, 0]), r"rotation: expected a finite \(3, 3\)"),
        ((1.0, np.full((3, 3), np.nan), [0, 0]), r"rotation: expected a finite \(3, 3\)"),
        ((1.0, 2.0 * np.eye(3), [0, 0]), "rotation: expected an orthonormal"),
        ((1.0, np.diag([1.0, 1.0, -1.0]), [0, 0]), "rotation: expected an orthonormal"),
        ((1.0, np.eye(3), [0, 0, 0]), "translation: expected 2 finite"),
        ((1.0, np.eye(3), [0, np.inf]), "translation: expected 2 finite"),
    ],
)
def test_bad_cameras(arguments, message):
    with pytest.raises(ValueError, match=message):
        ScaledOrthographicCamera(*arguments)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"size": 0}, "size: expected positive"),
        ({"size": (10, -1)}, "size: expected positive"),
        ({"extent": 0.0}, "extent: expected a finite length"),
        ({"centre": (0.0, 0.0)}, "centre: expected 3 finite"),
        ({"centre": (0.0, 0.0, np.nan)}, "centre: expected 3 finite"),
    ],
)
def test_bad_look(keywords, message):
    with pytest.raises(ValueError, match=message):
        ScaledOrthographicCamera.look(**keywords)


def test_bad_points(camera):
    with pytest.raises(ValueError, match=r"points: expected shape \(k, 3\)"):
        camera.project(np.zeros((4, 2)))
    with pytest.raises(ValueError, match=r"points: expected shape \(k, 3\)"):
        camera.depth(np.zeros(3))
    with pytest.raises(ValueError, match=r"px: expected shape \(k, 2\)"):
        camera.unproject(np.zeros((4, 3)), 0.0)
    with pytest.raises(ValueError, match=r"depth: expected shape \(4,\)"):
        camera.unproject(np.zeros((4, 2)), np.zeros(3))
    with pytest.raises(ValueError, match="factor: expected"):
        camera.scaled(-1.0)
