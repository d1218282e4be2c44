"""The light of the fit is divided out of the picture, where there is a face."""

import dataclasses

import numpy as np
import pytest

from toongeo import photometric_fit
from toongeo.pipeline.texture.face_picture import face_picture
from toongeo.pipeline.texture.remove_shading import remove_shading

WHITE = np.zeros((9, 3))
WHITE[0] = 2 * np.sqrt(np.pi)  # radiance 1 from everywhere: shading 1


@pytest.fixture(scope="module")
def lit(cartoon, fits, aligned):
    img, landmarks = cartoon("moustache_man")
    face = dataclasses.replace(aligned("moustache_man"), fit=photometric_fit(img, fits("moustache_man"), landmarks))
    return face, face_picture(img, face)


def relit(face, light):
    return dataclasses.replace(face, fit=dataclasses.replace(face.fit, light=light))


def test_light_of_one_everywhere_changes_nothing(lit):
    face, picture = lit
    apart = remove_shading(picture, relit(face, WHITE)).astype(int) - picture.pixels
    assert np.abs(apart).max() <= 1


def test_half_the_light_doubles_the_face_and_nothing_else(lit):
    face, picture = lit
    found = remove_shading(picture, relit(face, 0.5 * WHITE))
    outside = ~picture.fragments.mask
    assert outside.any()
    np.testing.assert_allclose(found[outside], picture.pixels[outside], atol=1)
    grey = picture.pixels[~outside].astype(float)
    assert (found[~outside].astype(float) >= grey - 1).all() and found[~outside].mean() > grey.mean() + 20


def test_a_fit_without_light_is_refused(aligned, lit):
    with pytest.raises(ValueError, match="delight: expected a fit with light"):
        remove_shading(lit[1], aligned("moustache_man"))
