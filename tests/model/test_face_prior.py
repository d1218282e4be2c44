"""The shipped prior: faces of people that know no left or right, and its checks."""

from dataclasses import fields, replace

import numpy as np
import pytest

from toongeo.model import data_path
from toongeo.model.artist_model import artist_model
from toongeo.model.ibug68 import INNER, MIRROR, PARTS

FLIP = np.array([-1.0, 1.0, 1.0])


@pytest.fixture(scope="module")
def prior(model):
    return model.prior


@pytest.fixture(scope="module")
def signs(model):
    mirrored = model.identity[:, model.mirror] * FLIP
    return np.sign((mirrored * model.identity).sum(axis=(1, 2)))


def test_a_face_and_its_mirror_image_are_equally_likely(model, prior, signs):
    mirrored = model.identity[:, model.mirror] * FLIP
    np.testing.assert_allclose(mirrored * signs[:, None, None], model.identity, atol=1e-6)
    assert np.sum(signs < 0) == 10
    np.testing.assert_array_equal(prior.mean[signs < 0], 0)
    assert signs[-1] > 0


def test_the_modes_are_principal_axes(model):
    """Their motions of the surface are orthogonal, the largest first."""
    modes = model.principal_modes.reshape(80, -1).astype(float)
    gram = modes @ modes.T
    sizes = np.sqrt(np.diag(gram))
    assert (np.diff(sizes) < 0).all()
    assert np.abs(gram / sizes / sizes[:, None] - np.eye(80)).max() < 2e-3  # they are stored in float16


def test_they_span_the_faces_of_the_artist(model, rng):
    artist = artist_model()
    with np.load(data_path("data_templates/prior.npz"), allow_pickle=False) as z:
        axes = z["axes"].astype(float)
    a = rng.standard_normal(80)
    own = np.append(a, 0)
    np.testing.assert_allclose(model.vertices(own), artist.vertices(axes @ a), atol=0.02)
    np.testing.assert_array_equal(model.mean, artist.mean)
    assert artist.prior is None
    for eye, plain in zip(model.eyes, artist.eyes, strict=True):
        (centre, radius), (expected, size) = eye.placed(own), plain.placed(axes @ a)
        np.testing.assert_allclose(centre, expected, atol=2e-3)
        assert radius == pytest.approx(size, abs=2e-3)


def test_landmarks_mirror(prior):
    np.testing.assert_allclose(prior.landmark_offsets[MIRROR] * FLIP, prior.landmark_offsets, atol=1e-5)
    mirrored = prior.landmark_covariance[MIRROR] * FLIP * FLIP[:, None]
    np.testing.assert_allclose(mirrored, prior.landmark_covariance, rtol=1e-5, atol=1e-5)


def test_the_landmarks_of_scans_mirror_and_lie_near(prior):
    offsets = prior.scan_offsets
    np.testing.assert_allclose(offsets[MIRROR] * FLIP, offsets, atol=1e-5)
    assert 1 < np.linalg.norm(offsets[INNER], axis=1).mean() < 5


def test_the_last_mode_moves_the_face_and_its_eyes_alike(model):
    """It leads from the likeliest face of the others to another face: lids go with the eyeballs, lips stay together."""
    mode = model.identity[-1]
    for eye, side in zip(model.eyes, ("left", "right"), strict=True):
        lids = mode[model.landmarks[PARTS[f"eye_{side}"]]].mean(axis=0)
        np.testing.assert_allclose(eye.centre_modes[-1], lids, atol=0.5)
    upper, lower = (mode[model.landmarks[k]] for k in (62, 66))
    np.testing.assert_allclose(upper, lower, atol=0.15)
    assert 0.5 < np.linalg.norm(mode[model.region("face")], axis=1).mean() < 1.5


def test_more_principal_modes_than_there_are_are_refused(prior):
    with pytest.raises(ValueError, match="n_principal: expected 1 to 81 or None, got 82"):
        replace(prior, n_principal=82)


def test_inner_points_are_the_template_s_and_known_to_a_few_millimetres(prior):
    np.testing.assert_array_equal(prior.landmark_offsets[INNER], 0)
    deviations = np.sqrt(np.linalg.eigvalsh(prior.landmark_covariance))
    assert deviations[INNER].max() < 8
    assert deviations[INNER].mean() < 3 < deviations[PARTS["jaw"]].mean()


def test_it_is_small_and_read_only(prior):
    assert data_path("data_templates/prior.npz").stat().st_size < 100_000
    for field in fields(prior):
        if field.name == "n_principal":
            continue
        with pytest.raises(ValueError, match="read-only"):
            getattr(prior, field.name)[...] = 0


@pytest.mark.parametrize("name", ["mean", "landmark_offsets", "landmark_covariance", "scan_offsets"])
def test_a_wrong_shape_is_named(prior, name):
    with pytest.raises(ValueError, match=f"{name}: expected shape"):
        replace(prior, **{name: np.zeros((2, 2))})


def test_a_matrix_that_is_no_covariance_is_refused(prior):
    skewed = prior.landmark_covariance.copy()
    skewed[..., 0, 1] += 1
    for matrices in (-prior.landmark_covariance, skewed):
        with pytest.raises(ValueError, match="landmark_covariance: expected symmetric positive definite"):
            replace(prior, landmark_covariance=matrices)


def test_a_prior_of_another_model_is_refused(model, prior):
    with pytest.raises(ValueError, match=r"prior: expected a mean of shape \(81,\), got \(3,\)"):
        replace(model, prior=replace(prior, mean=np.zeros(3), n_principal=3))
