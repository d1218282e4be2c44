"""What notebooks show of results."""

import cv2
import numpy as np
import pytest

from toongeo import ScaledOrthographicCamera, fit_3dmm
from toongeo.model import MorphableModel, default_model
from toongeo.notebook import picture
from toongeo.pipeline import Rig, RigReport
from toongeo.protocols import FaceLabel, FaceParse


def decoded(png):
    """Pixels (h, w, 3) RGB of a PNG."""
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)[:, :, ::-1]


def test_an_avatar_is_a_small_picture_and_a_short_text(avatar):
    """As the last line of a cell it once printed 282,255 characters."""
    png = avatar._repr_png_()
    assert len(png) <= 300_000 and len(repr(avatar)) < 500
    tiles = np.split(decoded(png), 4, axis=1)
    np.testing.assert_array_equal(tiles[0], avatar.render(avatar.pose, 240))
    assert all(np.abs(tile - tiles[0].astype(int)).max() > 50 for tile in tiles[1:])


@pytest.mark.parametrize("stage", ["fit", "face", "rig", "parse"])
def test_each_stage_has_its_picture(avatar, stage):
    result = getattr(avatar, stage)
    img = decoded(result._repr_png_())
    np.testing.assert_array_equal(img, picture(result))
    assert img.std() > 10 and len(repr(result)) < 2000


def test_a_fit_is_shown_turned_as_in_its_picture(model):
    camera = ScaledOrthographicCamera.look(yaw=30.0)
    fit = fit_3dmm(None, camera.project(model.mean[model.landmarks]))
    tiles = np.split(picture(fit), 4, axis=1)
    turned = np.abs(tiles[0].astype(int) - tiles[2]).mean()  # the third is turned by 40 degrees
    assert turned < 0.7 * np.abs(tiles[1].astype(int) - tiles[2]).mean()


def test_models_are_shown_down_to_bare_skin(model):
    tiles = np.split(picture(model), 7, axis=1)
    assert all((tile != tiles[0]).any() for tile in tiles[1:])
    bare = MorphableModel(mean=model.mean, faces=model.faces, identity=model.identity[:1], landmarks=model.landmarks)
    assert len(np.split(decoded(bare._repr_png_()), 3, axis=1)) == 3


def test_a_rig_of_another_head_has_no_picture_of_its_own():
    empty = np.zeros((1, 5, 3), np.float32)
    rig = Rig(("jawOpen",), np.zeros((5, 3)), empty, np.zeros((8, 5, 3), np.float32), np.zeros(1), RigReport())
    assert rig._repr_png_() is None and len(default_model()._repr_png_()) > 1000


def test_labels_keep_their_places():
    labels = np.zeros((40, 60), np.uint8)
    labels[10:20, 30:50] = FaceLabel.HAIR
    img = picture(FaceParse(labels, np.ones((40, 60), np.float32)))
    assert img.shape == (40, 60, 3)
    assert (img[labels > 0] == img[15, 40]).all() and (img[0, 0] != img[15, 40]).any()
    large = picture(FaceParse(np.zeros((1000, 500), np.uint8), np.ones((1000, 500), np.float32)))
    assert large.shape == (480, 240, 3)


def test_show_is_the_page_in_a_frame(avatar):
    shown = avatar.show(height=400, title='a "face"', texture=None)
    assert len(repr(shown)) < 80
    text = shown._repr_html_()
    assert text.startswith("<iframe srcdoc=") and 'sandbox="allow-scripts allow-downloads"' in text
    assert "height:400px" in text and 'title="a &quot;face&quot;"' in text
    assert text.count("<") == 2  # all of the page is escaped
