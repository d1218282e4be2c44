from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo import PhotometricOptions, make_avatar, photometric_fit
from toongeo.avatar.making.refined import check_photometric, refined, refinement


def test_a_photograph_is_refined_by_itself(avatars, fits, cartoon):
    img, landmarks = cartoon("astronaut")
    fit = fits("astronaut")
    expected = photometric_fit(img, fit, landmarks, options=refinement(img, fit, "auto"))
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


@pytest.mark.parametrize("name", CARTOONS)
def test_a_photograph_of_a_person_is_told_from_drawings(name, cartoon, fits):
    assert (refinement(cartoon(name)[0], fits(name), "auto") is not None) == (name == "astronaut")


@pytest.mark.parametrize("name", ["einstein", "image_0010", "takeo"])
def test_portraits_are_of_people(name, shared):
    from toongeo import fit_3dmm
    from toongeo.io import read_image, read_landmarks

    folder = shared / "data" / "portraits"
    img = read_image(next(path for path in folder.glob(f"{name}.*") if path.suffix != ".pts"))
    assert refinement(img, fit_3dmm(img, read_landmarks(folder / f"{name}.pts")), "auto") is not None


def test_neither_a_face_that_the_model_misses_nor_one_without_colours(cartoon, fits):
    img, fit = cartoon("astronaut")[0], fits("astronaut")
    for rms in (4.1, np.nan):
        assert refinement(img, replace(fit, report=replace(fit.report, rms_percent=rms)), "auto") is None
    bare = replace(fit.model, albedo_mean=np.empty(0), albedo=np.empty(0))
    assert refinement(img, replace(fit, model=bare), "auto") is None
