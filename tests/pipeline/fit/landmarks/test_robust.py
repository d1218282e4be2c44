"""Robust landmarks: the kernels, what counts as an outlier, and fits with five of 68 points wrong."""

import importlib.util

import numpy as np
import pytest

from toongeo.io import read_landmarks
from toongeo.model import data_path
from toongeo.model.ibug68 import INNER, MIRROR, OUTER_EYES, PARTS
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.landmarks.outlier_errors import NEIGHBOURS, outlier_errors
from toongeo.pipeline.fit.landmarks.robust_weights import KERNELS, robust_weights
from toongeo.render import ScaledOrthographicCamera


def with_outliers(points, seed, count=5):
    """Points moved by 0.4 to 1 outer-eye distances in any direction, and which."""
    rng = np.random.default_rng(seed)
    chosen = rng.choice(68, count, replace=False)
    angle, unit = rng.uniform(0, 2 * np.pi, count), np.linalg.norm(np.subtract(*points[list(OUTER_EYES)]))
    moved = points.copy()
    away = rng.uniform(0.4, 1.0, count) * unit
    moved[chosen] += away[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return moved, chosen


def inner_rms(fit, points):
    error = np.linalg.norm((fit.project(fit.vertices[fit.landmark_vertices]) - points)[INNER], axis=1)
    return np.sqrt((error**2).mean())


# --- kernels ---


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_weight_is_the_slope_of_its_kernel(kernel):
    """Twice the error weighs less, never more, and the pull of a huge error is bounded."""
    t = np.geomspace(1e-3, 1e12, 200)
    weights = KERNELS[kernel](t)
    assert (np.diff(weights) <= 0).all()
    assert weights[0] == pytest.approx(1, abs=1e-3)
    assert (weights * np.sqrt(t)).max() < 7


def test_the_kernels_in_closed_form():
    np.testing.assert_allclose(KERNELS["huber"](np.array([0.0, 6.25, 25.0, 625.0])), [1, 1, 0.5, 0.1])
    np.testing.assert_allclose(KERNELS["geman-mcclure"](np.array([0.0, 25.0, 41.0, 73.0])), [1, 1, 1 / 4, 1 / 16])


@pytest.mark.parametrize(("kernel", "weight"), [("huber", 2.5 / 41**0.5), ("geman-mcclure", 1 / 4)])
def test_the_unit_is_the_deviation_that_the_median_tells(kernel, weight):
    """Half of all 2D errors with unit variance a coordinate are longer than sqrt(2 log 2)."""
    variance = 9.0
    squares = variance * np.array([2 * np.log(2)] * 5 + [41.0])
    np.testing.assert_allclose(robust_weights(squares, kernel, 0.0), [1, 1, 1, 1, 1, weight], rtol=1e-12)


@pytest.mark.parametrize("kernel", KERNELS)
def test_the_scale_of_the_errors_is_their_median(kernel, rng):
    squares = rng.chisquare(2, 68)
    squares[:5] = 1e6
    weights = robust_weights(squares, kernel, 0.0)
    np.testing.assert_allclose(robust_weights(1e8 * squares, kernel, 0.0), weights, rtol=1e-12)
    assert weights[:5].max() < 0.01
    assert np.median(weights[5:]) > 0.9


def test_an_expected_error_is_no_outlier_however_well_the_rest_fits():
    squares = np.append(np.zeros(20), 1.0)
    assert robust_weights(squares, "geman-mcclure", 1.0).min() > 0.9
    np.testing.assert_array_equal(robust_weights(np.zeros(9), "huber", 0.0), np.ones(9))


def test_points_without_an_error_and_least_squares_weigh_one():
    squares = np.array([1.0, np.nan, 1.0, 1.0, 1e9])
    assert robust_weights(squares, "huber", 0.0)[1] == 1
    np.testing.assert_array_equal(robust_weights(squares, None, 0.0), np.ones(5))
    np.testing.assert_array_equal(robust_weights(np.full(3, np.nan), "huber", 0.0), np.ones(3))


def test_an_unknown_kernel_lists_the_known_ones():
    with pytest.raises(ValueError, match="robust: expected one of None, 'huber', 'geman-mcclure', got 'tukey'"):
        FitOptions(robust="tukey")


# --- what is odd ---


def test_neighbours_are_symmetric_and_mirrored():
    np.testing.assert_array_equal(NEIGHBOURS, NEIGHBOURS.T)
    np.testing.assert_array_equal(NEIGHBOURS[np.ix_(MIRROR, MIRROR)], NEIGHBOURS)
    assert NEIGHBOURS.sum(axis=1).min() >= 1
    assert not NEIGHBOURS.diagonal().any()


@pytest.mark.parametrize("part", ["eye_left", "mouth", "brow_right", "jaw"])
def test_a_part_that_moves_as_a_whole_is_not_odd(part):
    errors = np.zeros((68, 2))
    errors[PARTS[part]] = [30, -12]
    np.testing.assert_allclose(outlier_errors(errors, NEIGHBOURS)[1][PARTS[part]], 0, atol=1e-12)


def test_a_point_that_moves_alone_is_odd():
    errors = np.zeros((68, 2))
    errors[[38, 57, 8]] = [30, -40]
    least = np.linalg.norm(outlier_errors(errors, NEIGHBOURS), axis=2).min(axis=0)
    np.testing.assert_allclose(least[[38, 57, 8]], 50)
    assert np.delete(least, [38, 57, 8]).max() == 0


def test_a_point_without_neighbours_is_judged_alone():
    reasons = outlier_errors(np.array([[3.0, 4.0]]), np.zeros((1, 1), bool))
    np.testing.assert_array_equal(reasons, [[[3, 4]], [[3, 4]]])


# --- fits ---


@pytest.mark.parametrize("kernel", KERNELS)
def test_five_gross_outliers_hardly_move_the_fit(model, annotated, random_face, kernel):
    ratios, least_squares, moved_mm = [], [], []
    for seed in range(10):
        camera = ScaledOrthographicCamera.look(yaw=8 * seed - 36, pitch=5)
        points = annotated(model, camera, *random_face(seed))
        points += np.random.default_rng(seed).normal(0, 1, (68, 2))
        wrong, chosen = with_outliers(points, seed)
        clean = fit_3dmm(None, points, robust=kernel)
        found = fit_3dmm(None, wrong, robust=kernel)
        if kernel == "geman-mcclure":
            assert set(found.report.outliers) >= set(chosen) - set(PARTS["jaw"])
        ratios.append(inner_rms(found, points) / inner_rms(clean, points))
        least_squares.append(inner_rms(fit_3dmm(None, wrong, robust=None), points) / inner_rms(clean, points))
        moved_mm.append(np.linalg.norm(found.vertices - clean.vertices, axis=1)[model.region("face")].mean())
    assert np.median(ratios) < {"geman-mcclure": 1.1, "huber": 3.0}[kernel]  # Huber's outliers still pull a little
    assert np.median(least_squares) > 4
    assert np.median(moved_mm) < 1.5


def test_clean_points_give_the_face_of_least_squares(model, annotated, random_face):
    for seed in range(5):
        points = annotated(model, ScaledOrthographicCamera.look(yaw=10 * seed), *random_face(seed))
        noise = np.random.default_rng(seed).normal(0, 1, (68, 2))
        robust, plain = (fit_3dmm(None, points + noise, robust=kernel) for kernel in ("geman-mcclure", None))
        assert robust.report.outliers == ()
        moved = np.linalg.norm(robust.vertices - plain.vertices, axis=1)[model.region("face")]
        other = np.linalg.norm(fit_3dmm(None, points).vertices - plain.vertices, axis=1)[model.region("face")]
        assert moved.mean() < max(other.mean(), 0.3)  # less than the noise itself moves it


@pytest.mark.parametrize("picture", ["manga_girl", "beethoven", "bad_guy", "blue_girl"])
def test_a_caricature_is_no_outlier(picture):
    points = read_landmarks(data_path(f"examples/portraits/{picture}.pts"))
    robust, plain = (fit_3dmm(None, points, robust=kernel).report for kernel in ("geman-mcclure", None))
    assert robust.outliers == ()
    assert robust.rms_percent < 1.1 * plain.rms_percent


def test_five_gross_outliers_on_scanned_faces(shared, model):
    spec = importlib.util.spec_from_file_location("ict_truth", shared / "bench" / "ict_truth.py")
    bench = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(bench)
    truth = bench.Truth(shared / "data" / "models" / "ict_facekit" / "ict_facekit_light.npz")
    skin = model.faces[model.region("skin")[model.faces].all(1)]
    clean, wrong = [], []
    for seed in range(1000, 1004):
        face = truth.sample(seed)
        for points, errors in ((face["q"], clean), (with_outliers(face["q"], seed)[0], wrong)):
            V = fit_3dmm(None, points).vertices
            errors.append(bench.error_mm(truth, face, V, skin, V[model.landmarks[bench.SEVEN]], iters=8)[0])
    assert np.mean(wrong) < 1.1 * np.mean(clean)
