"""The photometric term: slopes, closed-form light, recovery of rendered faces, equivariance, pictures, bad input."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.geometry import vertex_normals
from toongeo.io import read_image, read_landmarks
from toongeo.metrics import check_gradient
from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline import PhotometricOptions, photometric_fit, rendered_picture, residual_map
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.frame.canonical_frame import CanonicalFrame
from toongeo.pipeline.fit.photometric.gauss_newton_step import gauss_newton_step
from toongeo.pipeline.fit.photometric.light_and_albedo import best_light, light_penalty
from toongeo.pipeline.fit.photometric.photometric_problem import PhotometricProblem
from toongeo.pipeline.fit.photometric.photometric_samples import photometric_samples
from toongeo.pipeline.fit.photometric.quadratic_model import QuadraticModel
from toongeo.pipeline.fit.photometric.rectified_picture import RectifiedPicture, rectified_picture
from toongeo.pipeline.fit.photometric.sample_normals import sample_normals
from toongeo.pipeline.fit.photometric.shading_basis import shading_basis, shading_slope
from toongeo.pipeline.fit.photometric.skin_likelihood import skin_likelihood
from toongeo.pipeline.fit.photometric.visible_samples import visible_samples
from toongeo.render import (
    ScaledOrthographicCamera,
    Surface,
    irradiance,
    linear_to_srgb,
    render_mesh,
    sh_basis,
    srgb_to_linear,
    studio_light,
)

SIZE = 360
BLOCKS = ["identity", "expression", "rotation", "log_scale", "translation", "albedo", "light", "everything"]


def random_light(rng):
    """Ambient light and a lamp from the front."""
    towards = rng.normal(size=3)
    towards[2] = abs(towards[2]) + 0.5
    light = np.zeros((9, 3))
    light[0] = 0.45 * np.sqrt(4 * np.pi)
    return light + 0.5 * np.pi * rng.uniform(0.8, 1.2, 3) * sh_basis(towards[None] / np.linalg.norm(towards)).T


@pytest.fixture(scope="module")
def rendered(model, annotated, random_face):
    """Function ``seed -> (picture, landmarks, identity, expression, camera, albedo, light)``."""

    def draw(seed):
        rng = np.random.default_rng(seed)
        identity, expression = random_face(seed)
        albedo = 0.7 * rng.standard_normal(len(model.albedo))
        camera = ScaledOrthographicCamera.look(*rng.uniform([-25, -10, -10], [25, 10, 10]), size=SIZE)
        light = random_light(rng)
        colours = np.clip(model.albedo_mean + np.tensordot(albedo, model.albedo, 1), 0, 1)
        surface = Surface(model.vertices(identity, expression), model.faces, colours=colours)
        picture = render_mesh(surface, camera, SIZE, light=light)
        landmarks = annotated(model, camera, identity, expression) + rng.normal(0, 0.7, (68, 2))
        return picture, landmarks, identity, expression, camera, albedo, light

    return draw


@pytest.fixture(scope="module")
def subject(rendered):
    return rendered(3)


@pytest.fixture(scope="module")
def fitted(subject):
    """Landmarks-only fit and photometric fit of one rendered face."""
    fit = fit_3dmm(*subject[:2])
    return fit, photometric_fit(subject[0], fit, subject[1])


@pytest.fixture(scope="module")
def pass_loss(subject, fitted):
    """The loss of the first pass in float64, and a vector near its start with albedo and light."""
    problem = PhotometricProblem.of(
        subject[0], fitted[0], subject[1], None, PhotometricOptions(samples=1500), FitOptions()
    )
    samples = problem.samples
    problem = replace(problem, samples=replace(samples, modes=samples.modes.astype(np.float64)))
    loss = problem.loss(problem.z0, problem.frozen(problem.z0))
    rng = np.random.default_rng(0)
    # A picture that bilinear interpolation reproduces has no kinks at the borders of pixels.
    height, width = problem.plane.confidence.shape
    v, u = np.meshgrid(np.linspace(-1, 1, height), np.linspace(-1, 1, width), indexing="ij")
    light = 0.3 + np.stack([u, v, u * v], axis=2) @ rng.uniform(-0.1, 0.1, (3, 3))
    loss = replace(loss, photometric=replace(loss.photometric, plane=replace(problem.plane, light=light)))
    z = problem.z0 + 0.02 * rng.standard_normal(len(problem.z0))
    return loss, z


def block_of(loss, name):
    if name == "everything":
        return slice(0, loss.size)
    return getattr(loss, name) if name in ("albedo", "light") else getattr(loss.unknowns, name)


# --- slopes ---


@pytest.mark.parametrize("block", BLOCKS)
def test_the_gradient_of_the_photometric_loss(pass_loss, block):
    loss, z = pass_loss
    x, _ = loss.full(z)
    x[loss.photometric.light] *= 1.1  # away from the best light, where that block's gradient vanishes
    direction = np.zeros(len(x))
    chosen = block_of(loss.photometric, block)
    direction[chosen] = np.random.default_rng(1).standard_normal(direction[chosen].shape)
    photometric = loss.photometric

    def value(x):
        observed = photometric.observe(x)
        r = photometric.residuals(x, observed).ravel()
        return float(r @ r), 2 * r @ photometric.jacobian(x, observed)

    assert check_gradient(value, x, direction).passed


@pytest.mark.parametrize("block", [block for block in BLOCKS if block != "light"])
def test_the_gradient_with_the_light_eliminated(pass_loss, block):
    loss, z = pass_loss
    direction = np.zeros(len(z))
    chosen = slice(0, len(z)) if block == "everything" else block_of(loss.photometric, block)
    direction[chosen] = np.random.default_rng(2).standard_normal(direction[chosen].shape)
    assert check_gradient(lambda z: (loss(z), loss.model(z).gradient), z, direction).passed


@pytest.mark.parametrize("block", BLOCKS)
def test_the_jacobian_of_the_residuals(pass_loss, block):
    loss, z = pass_loss
    x, observed = loss.full(z)
    photometric = loss.photometric
    d = np.zeros(len(x))
    d[block_of(photometric, block)] = 1.0
    plus, minus = (photometric.residuals(at, photometric.observe(at)) for at in (x + 1e-6 * d, x - 1e-6 * d))
    difference = (plus - minus).ravel() / 2e-6
    np.testing.assert_allclose(photometric.jacobian(x, observed) @ d, difference, atol=1e-6 * np.abs(difference).max())


def test_the_model_of_a_step_is_that_of_all_residuals_with_the_best_light(pass_loss):
    """Minimised over the light, the quadratic model of everything is the model that a step uses.

    Landmarks, prior and ridge are quadratic but for the pose; the residuals are differenced.
    """
    loss, z = pass_loss
    rows = np.arange(0, len(loss.photometric.weights), 12)
    small = replace(
        loss.photometric,
        samples=loss.photometric.samples.subset(rows),
        slopes=loss.photometric.slopes[rows],
        weights=loss.photometric.weights[rows],
    )
    loss = replace(loss, photometric=small)
    x, _ = loss.full(z)
    J = np.empty((3 * len(rows), small.size))
    for k in range(small.size):
        d = np.zeros(small.size)
        d[k] = 1e-6
        plus, minus = (small.residuals(at, small.observe(at)) for at in (x + d, x - d))
        J[:, k] = (plus - minus).ravel() / 2e-6
    normal = J.T @ J
    n, size = small.unknowns.size, len(z)
    normal[size:, size:] += np.diag(np.repeat(loss.penalty, 3) + 1e-9 * np.trace(normal[size:, size:]))
    whole = 2 * loss.photometric_weight * normal
    whole[:n, :n] += loss.geometry.normal(z[:n])[2]
    whole[n:size, n:size] += 2 * loss.albedo_weight * np.eye(size - n)
    model = loss.model(z)
    expected = np.linalg.inv(np.linalg.inv(whole)[:size, :size])  # of a block of the inverse: Schur's complement
    units = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(model.matrix / units, expected / units, atol=1e-5)
    assert model.value == loss(z)


def test_a_step_never_raises_the_loss(pass_loss, subject, fitted):
    """From the start of a pass, from a bad place, and at the end, where nothing is left to gain."""
    loss, z = pass_loss
    bounds = np.full(len(z), -3.0), np.full(len(z), 3.0)
    settings = {"algorithm": "LD_LBFGS", "tolerance": 1e-9, "max_evaluations": 2000}
    rng = np.random.default_rng(4)
    for spread in (0.0, 0.5):
        at = np.clip(z + spread * rng.standard_normal(len(z)), *bounds)
        values = [loss(at)]
        for _ in range(5):
            step = gauss_newton_step(loss, at, bounds=bounds, **settings)
            assert step.value == loss(step.z)
            assert (step.z >= bounds[0]).all() and (step.z <= bounds[1]).all()
            at = step.z
            values.append(step.value)
        assert (np.diff(values) <= 0).all()
        assert values[1] < values[0]
        assert values[-2] - values[-1] < 0.02 * (values[0] - values[-1])


def test_a_step_that_leads_nowhere_is_not_taken():
    """A model whose gradient points the wrong way."""

    class Uphill:
        def __call__(self, z):
            return float(z @ z)

        def model(self, z):
            return QuadraticModel(z, float(z @ z), -2 * z, 2 * np.eye(len(z)))

    start = np.array([1.0, -0.5])
    bounds = np.full(2, -9.0), np.full(2, 9.0)
    step = gauss_newton_step(Uphill(), start, bounds=bounds, algorithm="LD_LBFGS", tolerance=1e-9, max_evaluations=99)
    np.testing.assert_array_equal(step.z, start)
    assert step.value == 1.25


def test_shading_is_that_of_the_renderer_and_its_slope_too(rng):
    normals = rng.normal(size=(50, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = rng.normal(size=(9, 3))
    np.testing.assert_allclose(shading_basis(normals) @ light, irradiance(normals, light) / np.pi, atol=1e-12)

    def value(x):
        at = x.reshape(50, 3)
        return float((shading_basis(at) @ light[:, 0]).sum()), shading_slope(at, light[:, 0]).ravel()

    assert check_gradient(value, normals.ravel(), rng.normal(size=150)).passed


def test_normals_of_the_samples_are_those_of_the_mesh_and_their_slope_is_right(model, random_face, rng):
    samples = photometric_samples(model, 800)
    ring = np.flatnonzero(
        np.isin(np.arange(len(model.mean)), model.faces[np.isin(model.faces, samples.vertices).any(1)])
    )
    V = model.vertices(*random_face(5))
    for rows in (np.arange(len(samples.vertices)), np.arange(0, len(samples.vertices), 3)):
        part = samples.subset(rows)
        expected = vertex_normals(V, model.faces)[part.vertices]
        np.testing.assert_allclose(sample_normals(V[ring], part).units, expected, atol=1e-12)
    part = replace(part, modes=part.modes.astype(np.float64))
    wanted, moved = rng.normal(size=(2, len(part.vertices), 2, 3))

    def value(x):
        found = sample_normals(x.reshape(-1, 3), part)
        quantities = wanted @ found.units[:, :, None] + moved @ x.reshape(-1, 3)[part.own][:, :, None]
        return float(quantities.sum()), found.derivative(wanted, moved).sum(axis=0)

    direction = 0.02 * rng.normal(size=3 * len(ring))
    assert check_gradient(value, V[ring].ravel(), direction).passed


def test_the_slope_of_the_picture_is_that_of_its_interpolant(rng):
    plane = RectifiedPicture(rng.random((9, 7, 3), np.float32), np.ones((9, 7), np.float32), 0.5, -1.5, 2.0)
    points = np.column_stack([rng.uniform(-1.4, 1.4, 40), rng.uniform(-1.9, 1.9, 40)])
    _, slope = plane.sample(points)
    for axis, step in enumerate(np.eye(2) * 1e-6):
        difference = (plane.sample(points + step)[0] - plane.sample(points - step)[0]) / 2e-6
        np.testing.assert_allclose(slope[:, :, axis], difference, atol=1e-6)
    beyond, flat = plane.sample(np.array([[-9.0, 9.0]]))
    np.testing.assert_allclose(beyond[0], plane.light[0, 0])
    assert not flat.any()
    assert plane.confidence_at(np.array([[-9.0, 9.0], [0.0, 0.0]])).tolist() == [0.0, 1.0]


# --- light in closed form ---


def test_shading_is_irradiance(rng):
    normals = rng.standard_normal((20, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = rng.standard_normal((9, 3))
    np.testing.assert_allclose(shading_basis(normals) @ light, irradiance(normals, light) / np.pi, atol=1e-14)


def test_the_light_of_a_rendering_is_found_exactly(pass_loss):
    loss, z = pass_loss
    photometric = loss.photometric
    x, observed = loss.full(z)
    light = random_light(np.random.default_rng(4))
    x[photometric.light] = light.ravel()
    exact = replace(observed, seen=photometric.rendered(x, observed))
    np.testing.assert_allclose(best_light(photometric, exact, np.zeros(9)), light, atol=1e-4)


def test_at_the_best_light_its_gradient_vanishes(pass_loss):
    loss, z = pass_loss
    photometric = loss.photometric
    x, observed = loss.full(z)
    light = x[photometric.light].reshape(9, 3)
    slope = 2 * photometric.residuals(x, observed).ravel() @ photometric.jacobian(x, observed)
    gradient = slope[photometric.light].reshape(9, 3)
    np.testing.assert_allclose(gradient + 2 * loss.penalty[:, None] * light, 0, atol=1e-9)


def test_the_ridge_spares_the_ambient_light(pass_loss):
    loss, z = pass_loss
    penalty = light_penalty(loss.photometric, loss.full(z)[1], 0.1)
    assert penalty[0] == 0
    assert np.ptp(penalty[1:]) == 0 and penalty[1] > 0


# --- samples and picture ---


@pytest.mark.parametrize("count", [500, 3000, 10**6])
def test_samples_are_spread_over_both_halves_alike(model, count):
    samples = photometric_samples(model, count)
    face = model.region("face")
    assert face[samples.vertices].all()
    np.testing.assert_array_equal(np.sort(model.mirror[samples.vertices]), samples.vertices)
    assert abs(len(samples.vertices) - min(count, face.sum())) <= 0.02 * count
    front = model.faces[face[model.faces].all(axis=1)]
    a, b, c = model.mean[front].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert samples.area.sum() == pytest.approx(area, rel=0.02)


def test_a_turned_head_hides_the_far_side_of_its_nose(model):
    """Seen from the front nearly everything is visible; at 60 degrees the far cheek beside the nose is not."""
    samples = photometric_samples(model, 3000)
    assert visible_samples(model.mean, samples).mean() > 0.95
    turned = {sign: model.mean @ ScaledOrthographicCamera.look(yaw=sign * 60).rotation.T for sign in (-1, 1)}
    seen = {sign: visible_samples(posed, samples) for sign, posed in turned.items()}
    right = model.mean[samples.vertices, 0] < 0
    assert seen[-1][right].mean() < 0.7 < 0.9 < seen[1][right].mean()
    partner = np.searchsorted(samples.vertices, model.mirror[samples.vertices])
    assert (seen[1] == seen[-1][partner]).mean() > 0.995


def test_the_plane_shows_the_picture_upright_and_in_millimetres():
    """A linear ramp is reproduced by every filter on the way, whatever the size of the picture."""
    for scale in (0.7, 3.0, 11.0):
        frame = CanonicalFrame(scale, np.eye(3), np.array([60.0, 55.0]) * scale, np.eye(3))
        side = int(120 * scale)
        ramp = np.linspace(0, 1, side)
        img = np.round(255 * linear_to_srgb(np.broadcast_to(ramp[None, :, None], (side, side, 3)))).astype(np.uint8)
        face = np.array([[-20.0, -25.0], [20.0, 25.0]])
        plane = rectified_picture(img, None, frame, face, step=0.6, blur=1.0)
        points = np.array([[0.0, 0.0], [10.0, 5.0], [-15.0, 20.0]])
        expected = (frame.origin[0] + scale * points[:, 0]) / (side - 1)
        np.testing.assert_allclose(plane.sample(points)[0][:, 0], expected, atol=0.01)
        np.testing.assert_allclose(plane.confidence_at(points), 1, atol=1e-6)


def test_skin_is_the_commonest_colour():
    """Green skin, with a third of the core covered by dark hair."""
    light = np.full((40, 60, 3), [0.1, 0.5, 0.15], np.float32)
    light[:, 40:] = [0.02, 0.012, 0.01]
    light *= np.linspace(0.7, 1.3, 40, dtype=np.float32)[:, None, None]  # shading
    plane = RectifiedPicture(light, np.ones((40, 60), np.float32), 1.0, 0.0, 39.0)
    core = np.stack(np.meshgrid(np.arange(60.0), np.arange(40.0)), 2).reshape(-1, 2)
    likelihood = skin_likelihood(plane, core)
    assert likelihood[:, :40].min() > 0.95
    assert likelihood[:, 40:].max() < 0.05
    empty = replace(plane, confidence=np.zeros((40, 60), np.float32))
    np.testing.assert_array_equal(skin_likelihood(empty, core), 1)


# --- recovery ---


@pytest.mark.parametrize("seed", [1, 3, 4])
def test_a_rendered_face_is_recovered(model, rendered, seed):
    picture, landmarks, identity, expression, camera, albedo, light = rendered(seed)
    fit = fit_3dmm(picture, landmarks)
    refined = photometric_fit(picture, fit, landmarks)
    face = model.region("face")
    truth = model.vertices(identity, expression)

    def shape_error(found):
        a, b = found.vertices[face], truth[face]
        a, b = a - a.mean(0), b - b.mean(0)
        U, s, Vt = np.linalg.svd(b.T @ a)
        return np.linalg.norm(s.sum() / (a**2).sum() * a @ (U @ Vt).T - b, axis=1).mean()

    assert shape_error(refined) < shape_error(fit)
    true_albedo, found = (
        srgb_to_linear(model.albedo_mean + np.tensordot(a, model.albedo, 1))[face] for a in (albedo, refined.albedo)
    )
    gain = (found * true_albedo).sum(0) / (found**2).sum(0)
    assert np.sqrt(((gain * found - true_albedo) ** 2).mean() / (true_albedo**2).mean()) < 0.03

    normals = vertex_normals(truth, model.faces) @ camera.rotation.T
    front = face & (normals[:, 2] > 0.3)
    shaded = [
        rho[front[face]] * irradiance(n[front], L) / np.pi
        for rho, n, L in (
            (true_albedo, normals, light),
            (found, vertex_normals(refined.vertices, model.faces) @ refined.camera.rotation.T, refined.light),
        )
    ]
    assert np.sqrt(((shaded[1] - shaded[0]) ** 2).mean() / (shaded[0] ** 2).mean()) < 0.025
    difference = residual_map(picture, refined)
    assert np.sqrt(np.nanmean(difference**2)) < 0.02


def test_the_report(fitted):
    fit, refined = fitted
    report = refined.photometric
    assert report.residual_after < 0.75 * report.residual_before < report.residual_ambient
    assert 0.6 < report.confident_fraction <= 1
    assert report.passes == PhotometricOptions().passes
    assert report.evaluations <= report.passes * PhotometricOptions().steps * (PhotometricOptions().max_evaluations + 1)
    assert report.seconds > 0 and refined.report.seconds > fit.report.seconds
    assert refined.albedo.shape == (9,) and refined.light.shape == (9, 3)
    assert fit.albedo is None and fit.photometric is None
    for array in (refined.albedo, refined.light):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_the_landmark_error_in_the_report_is_that_of_the_new_face(subject, fitted):
    refined = fitted[1]
    projected = refined.project(refined.vertices[refined.landmark_vertices])
    rms = np.sqrt(((projected - subject[1])[17:] ** 2).sum(axis=1).mean())
    assert refined.report.rms_px == pytest.approx(rms, rel=1e-9)


def test_fit_3dmm_goes_on_by_itself(subject, fitted):
    both = fit_3dmm(*subject[:2], photometric=True)
    np.testing.assert_array_equal(both.vertices, fitted[1].vertices)
    np.testing.assert_array_equal(both.light, fitted[1].light)


# --- robustness ---


@pytest.mark.parametrize("with_mask", [False, True], ids=["skin likelihood", "mask"])
def test_hair_over_half_the_forehead_hardly_pulls(model, subject, fitted, with_mask):
    picture, landmarks = subject[:2]
    fit, refined = fitted
    left = fit.project(fit.vertices[model.region("forehead") & (model.mean[:, 0] > 0)])
    (x0, y0), (x1, y1) = left.min(0).astype(int), left.max(0).astype(int)
    covered = picture.copy()
    covered[y0 - 20 : y1, x0 : x1 + 20] = [40, 25, 15]
    mask = np.ones(picture.shape[:2])
    mask[y0 - 20 : y1, x0 : x1 + 20] = 0
    other = photometric_fit(covered, fit, landmarks, mask=mask if with_mask else None)
    face = model.region("face")
    assert np.linalg.norm(other.vertices[face] - refined.vertices[face], axis=1).mean() < 0.3
    pictures = [rendered_picture(found, picture.shape).astype(int) for found in (other, refined)]
    assert np.abs(pictures[0] - pictures[1]).mean() < 1.5


def test_a_mask_of_ones_says_everything_is_skin(subject, fitted):
    masked = photometric_fit(subject[0], fitted[0], subject[1], mask=np.ones((SIZE, SIZE), bool))
    assert masked.photometric.confident_fraction == pytest.approx(1, abs=1e-6)
    assert masked.photometric.residual_after < 0.02


# --- equivariance ---


def test_a_mirrored_picture_gives_the_mirrored_face(model, cartoon, subject):
    for picture, landmarks in (subject[:2], cartoon("astronaut"), cartoon("manga_girl")):
        flipped = np.ascontiguousarray(picture[:, ::-1])
        points = (landmarks * [-1, 1] + [picture.shape[1] - 1, 0])[MIRROR]
        one, other = (photometric_fit(p, fit_3dmm(p, q), q) for p, q in ((picture, landmarks), (flipped, points)))
        np.testing.assert_allclose(other.vertices[model.mirror] * [-1, 1, 1], one.vertices, atol=0.05)


def test_size_and_place_in_the_picture_change_little(model, subject, fitted):
    """Every pixel four times, and a frame around: the same light falls on the same points."""
    picture, landmarks = subject[:2]
    larger = np.pad(picture.repeat(2, axis=0).repeat(2, axis=1), ((31, 7), (12, 50), (0, 0)), mode="edge")
    points = (landmarks + 0.5) * 2 - 0.5 + [12, 31]
    other = photometric_fit(larger, fit_3dmm(larger, points), points)
    face = model.region("face")
    assert np.linalg.norm(other.vertices[face] - fitted[1].vertices[face], axis=1).mean() < 0.15
    np.testing.assert_allclose(other.light, fitted[1].light, atol=0.1)


def test_twice_the_same_to_the_last_bit(subject, fitted):
    again = photometric_fit(subject[0], fitted[0], subject[1])
    assert again.vertices.tobytes() == fitted[1].vertices.tobytes()
    assert again.light.tobytes() == fitted[1].light.tobytes()


# --- pictures ---


@pytest.mark.parametrize("picture", ["bad_guy", "blue_girl", "manga_girl"])
def test_drawings_keep_the_face_of_their_landmarks(cartoon, fits, model, picture):
    img, landmarks = cartoon(picture)
    fit = fits(picture)
    refined = photometric_fit(img, fit, landmarks)
    face = model.region("face")
    assert np.linalg.norm((refined.vertices - fit.vertices)[face], axis=1).mean() < 1.0
    assert refined.report.rms_percent < fit.report.rms_percent + 0.2
    assert refined.photometric.residual_after < 0.13
    assert np.abs(refined.albedo).max() <= 3


@pytest.mark.parametrize("portrait", ["einstein.jpg", "image_0010.png", "takeo.png"])
def test_portraits_are_explained_better(shared, portrait):
    path = shared / "data" / "portraits" / portrait
    img, landmarks = read_image(path), read_landmarks(path.with_suffix(".pts"))
    report = fit_3dmm(img, landmarks, photometric=True).photometric
    assert report.residual_after < report.residual_before
    assert report.residual_after**2 < 0.5 * report.residual_ambient**2


def test_a_grey_picture_gets_grey_light(fitted, subject):
    grey = np.repeat(subject[0].mean(axis=2, keepdims=True).astype(np.uint8), 3, axis=2)
    picture = rendered_picture(photometric_fit(grey, fitted[0], subject[1]), grey.shape, background=grey)
    assert np.ptp(picture.astype(int), axis=2).mean() < 6


def test_the_rendered_picture_of_a_known_fit_is_the_renderers(model, fitted):
    light = studio_light()
    fit = replace(fitted[0], albedo=np.zeros(9), light=light)
    front = model.faces[model.region("face")[model.faces].all(axis=1)]
    normals = vertex_normals(fit.vertices, model.faces)
    surface = Surface(fit.vertices, front, colours=model.albedo_mean, normals=normals)
    expected = render_mesh(surface, fit.camera, (SIZE, SIZE), light=light, background=(0.5, 0.5, 0.5))
    np.testing.assert_array_equal(rendered_picture(fit, (SIZE, SIZE)), expected)
    difference = residual_map(expected, fit)
    assert (difference[np.isfinite(difference)] == 0).mean() > 0.97  # all but pixels that the border cuts
    covered = np.isfinite(difference).all(axis=2)
    assert (expected[~covered] == 128).mean() > 0.9
    albedo = rendered_picture(fit, (SIZE, SIZE), lit=False)
    assert np.abs(albedo[covered].mean(0) / 255 - model.albedo_mean[model.region("face")].mean(0)).max() < 0.05


# --- bad input ---


def test_bad_pictures_and_masks(subject, fitted):
    picture, landmarks = subject[:2]
    for img, mask, message in [
        (picture.astype(float), None, r"img: expected \(H, W, 3\) uint8 RGB, got float64"),
        (np.full(picture.shape, np.nan), None, "img: expected"),
        (picture[:, :, 0], None, "img: expected"),
        (picture, np.ones((10, 10)), r"mask: expected shape \(360, 360\) like the picture, got \(10, 10\)"),
        (picture, np.ones((SIZE, SIZE, 1)), "mask: expected shape"),
        (picture, np.ones((SIZE, SIZE), np.uint8), "mask: expected bool or float, got uint8"),
        (picture, np.full((SIZE, SIZE), 1.5), r"mask: expected values in \[0, 1\]"),
        (picture, np.full((SIZE, SIZE), np.nan), r"mask: expected values in \[0, 1\]"),
        (picture, np.zeros((SIZE, SIZE)), "mask: expected some of the face inside"),
    ]:
        with pytest.raises(ValueError, match=message):
            photometric_fit(img, fitted[0], landmarks, mask=mask)
    infinite, half, few = landmarks.copy(), landmarks.copy(), landmarks.copy()
    infinite[3], half[3, 1], few[5:] = np.inf, np.nan, np.nan
    for points, message in [
        (landmarks[:51], "landmarks: expected 68 points in iBUG order, got 51"),
        (infinite, "landmarks: expected finite px or NaN, got infinity in row 3"),
        (half, "landmarks: a missing point has NaN in both coordinates"),
        (few, "landmarks: expected at least 6 points that are not NaN, got 5"),
        (landmarks + 5000, "landmarks: .* points lie outside"),
        (landmarks.astype(str), "landmarks: expected numbers, got an array of <U"),
    ]:
        with pytest.raises(ValueError, match=message):
            photometric_fit(picture, fitted[0], points)
    with pytest.raises(ValueError, match="img: expected one picture for the photometric term, got None"):
        fit_3dmm(None, landmarks, photometric=True)


def test_what_the_photometric_term_would_undo_is_refused(subject, fitted):
    picture, landmarks = subject[:2]
    with pytest.raises(ValueError, match="img: expected one picture or None, got 2"):
        fit_3dmm([picture, picture], [landmarks, landmarks], photometric=True)
    with pytest.raises(ValueError, match="adjust: expected None with the photometric term"):
        fit_3dmm(picture, landmarks, photometric=True, adjust="expression")


def test_landmarks_of_a_table_are_refused(model, subject, fitted):
    picture, landmarks = subject[:2]
    with pytest.raises(ValueError, match="scheme: expected a scheme by name with the photometric term, got a table"):
        fit_3dmm(picture, landmarks, photometric=True, scheme=model.landmarks)
    with pytest.raises(ValueError, match="fit_options: expected a scheme by name, whose 68 points these are"):
        photometric_fit(picture, fitted[0], landmarks, fit_options=FitOptions(scheme=model.landmarks))


def test_a_black_picture_gives_no_light(subject, fitted):
    refined = photometric_fit(np.zeros_like(subject[0]), fitted[0], subject[1])
    np.testing.assert_allclose(refined.light, 0, atol=1e-6)
    off = np.linalg.norm(refined.vertices - fitted[0].vertices, axis=1)[refined.region("face")]
    assert off.mean() < 1.5  # mm: nothing but the landmarks and the prior is left


def test_what_needs_albedo_and_light_says_so(subject, fitted):
    with pytest.raises(ValueError, match="fit: expected one with albedo and light"):
        rendered_picture(fitted[0], (SIZE, SIZE))
    with pytest.raises(ValueError, match="fit: expected one with albedo and light"):
        residual_map(subject[0], fitted[0])
    with pytest.raises(ValueError, match="img: expected"):
        residual_map(subject[0].astype(float), fitted[1])


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("noise", 0.0, "noise: expected a finite number > 0, got 0.0"),
        ("albedo_weight", float("nan"), "albedo_weight: expected a finite number > 0"),
        ("passes", 0, "passes: expected an integer >= 1, got 0"),
        ("samples", 10.5, "samples: expected an integer >= 1, got 10.5"),
        ("passes", True, "passes: expected an integer >= 1, got True"),
        ("blur", "1", "blur: expected a finite number > 0, got '1'"),
        ("tolerance", None, "tolerance: expected a finite number > 0, got None"),
        ("noise", np.ones(2), "noise: expected a finite number > 0, got array"),
    ],
)
def test_bad_options(name, value, message):
    with pytest.raises(ValueError, match=message):
        PhotometricOptions(**{name: value})
