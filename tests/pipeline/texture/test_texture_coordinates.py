import numpy as np
import pytest

from toongeo.pipeline import texture_coordinates
from toongeo.render import uv_to_px


def test_they_are_the_projected_vertices_in_the_picture_as_atlas(cartoon, fits):
    img, fit = cartoon("blue_girl")[0], fits("blue_girl")
    uv = texture_coordinates(fit, img.shape)
    np.testing.assert_allclose(uv_to_px(uv, *img.shape[:2]), fit.project(fit.vertices), atol=1e-9)


def test_a_shape_that_is_none_is_refused(fits):
    with pytest.raises(ValueError, match=r"shape: expected \(H, W\) or \(H, W, 3\) of a picture, got \(3,\)"):
        texture_coordinates(fits("blue_girl"), (3,))
