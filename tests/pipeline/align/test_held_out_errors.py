"""Points that were left out are foretold by the others."""

import numpy as np
import pytest

from toongeo.avatar.make_avatar import make_avatar
from toongeo.pipeline import fit_3dmm, held_out_errors
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture
def exact(artist, random_face, annotated):
    """Landmarks of a face of the model, which all the others tell exactly where one is."""
    identity, expression = random_face(1)
    return annotated(
        artist, ScaledOrthographicCamera.look(yaw=10.0, size=512), identity[: len(artist.identity)], expression
    )


def test_a_face_of_the_model_is_foretold_and_a_wrong_point_is_not(artist, exact):
    errors = held_out_errors(None, exact, model=artist)
    assert set(errors) == {"brow", "nose", "eyes", "mouth", "inner51"}
    assert errors["inner51"] < 0.02
    wrong = exact.copy()
    wrong[33] += 0.2 * np.linalg.norm(exact[45] - exact[36])
    assert held_out_errors(None, wrong, model=artist)["nose"] > 0.05  # an aligned face would go through it


def test_missing_points_are_left_out_of_the_errors(artist, exact):
    some = exact.copy()
    some[27:36] = np.nan
    errors = held_out_errors(None, some, model=artist)
    assert np.isnan(errors["nose"]) and errors["mouth"] < 0.05


def test_a_given_fit_is_kept(cartoon):
    img, points = cartoon("moustache_man")
    fit = fit_3dmm(img, points)
    with pytest.raises(ValueError, match="fit: expected landmarks by name with it, and no snap, photometric or style"):
        make_avatar(img, points, fit=fit, snap=True)
    with pytest.raises(ValueError, match="fit: expected landmarks"):
        make_avatar(img, fit=fit)
    reached = []

    class Reached(Exception):
        pass

    def parser(img, landmarks, fit):
        reached.append(fit)
        raise Reached

    with pytest.raises(Reached):
        make_avatar(img, points, fit=fit, parser=parser)
    assert reached == [fit]
