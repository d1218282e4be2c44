"""Points that were left out are predicted by the others."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.avatar.make_avatar import make_avatar
from toongeo.pipeline import align_face, fit_3dmm, held_out_errors
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


def test_the_face_may_be_aligned_in_another_way_and_never_sees_what_is_left_out(artist, exact):
    """An alignment that misses by 10 px to the right: that is the error of what it was not shown, more or less."""
    shown = []

    def beside(fit, landmarks):
        shown.append(np.isfinite(landmarks).all(axis=1))
        face = align_face(fit, landmarks, noise=0)
        camera = face.camera
        return replace(
            face, camera=ScaledOrthographicCamera(camera.scale, camera.rotation, camera.translation + [10.0, 0.0])
        )

    errors = held_out_errors(None, exact, model=artist, align=beside)
    assert np.sum(shown, axis=0)[17:].tolist() == [3] * 51  # of four folds each inner point is left out of one
    assert errors["inner51"] * np.linalg.norm(exact[45] - exact[36]) == pytest.approx(10, rel=0.2)


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
