import numpy as np
import pytest

from toongeo import PhotometricOptions, make_avatar, photometric_fit
from toongeo.avatar.making.refined import check_photometric, refined, refinement
from toongeo.pipeline.fit.photometric_choice import photometric_choice


def test_a_photograph_is_refined_by_itself(avatars, fits, cartoon):
    img, landmarks = cartoon("astronaut")
    fit = fits("astronaut")
    expected = photometric_fit(img, fit, landmarks, options=photometric_choice(img, fit))
    np.testing.assert_array_equal(avatars("astronaut").fit.vertices, expected.vertices)
    assert refinement(img, fit, True) == PhotometricOptions() and refinement(img, fit, False) is None


def test_a_drawing_is_not(avatars):
    assert avatars("blue_girl").fit.photometric is None


def test_a_fit_that_is_given_is_kept(cartoon, fits):
    avatar = make_avatar(*cartoon("astronaut"), fit=fits("astronaut"), hair=False, texture_size=32)
    assert avatar.fit.photometric is None


def test_where_no_skin_is_seen_landmarks_are_enough(cartoon, fits, monkeypatch):
    img, landmarks = cartoon("astronaut")

    def blind(*_, **__):
        raise ValueError("mask: nothing of the face is in both picture and mask")

    monkeypatch.setattr("toongeo.avatar.making.refined.photometric_fit", blind)
    assert refined(img, fits("astronaut"), landmarks, PhotometricOptions(), asked=False) is fits("astronaut")
    with pytest.raises(ValueError, match="nothing of the face"):
        refined(img, fits("astronaut"), landmarks, PhotometricOptions(), asked=True)


@pytest.mark.parametrize("wrong", ["yes", None, 2])
def test_other_words_are_refused(wrong):
    with pytest.raises(ValueError, match="photometric: expected True, False or 'auto', got"):
        check_photometric(wrong)
