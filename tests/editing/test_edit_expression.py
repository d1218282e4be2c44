from dataclasses import replace

import cv2
import numpy as np
import pytest

from toongeo import ExpressionEditor, edit_expression, fit_3dmm
from toongeo.editing.edit_expression import reference_weights
from toongeo.model.anatomy.lid_rings import lid_rings

OPEN = {"jawOpen": 0.6}


@pytest.fixture(scope="module")
def picture(cartoon):
    return cartoon("moustache_man")


@pytest.fixture(scope="module")
def editor(picture, avatar):
    return ExpressionEditor(*picture, avatar=avatar)


def difference(a, b):
    return np.abs(a.astype(int) - b)


def test_the_pictures_own_expression_gives_the_picture(editor, picture):
    same = difference(editor.frame(editor.pose), picture[0])
    assert same.mean() < 0.3
    assert same[editor.region].mean() < 1.0


@pytest.mark.parametrize(
    "weights", [OPEN, {"mouthSmileLeft": 1.0}, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}, {"browInnerUpLeft": 1.0}]
)
def test_nothing_changes_outside_the_region(editor, picture, weights):
    frame = editor.frame(weights)
    changed = difference(frame, picture[0]).max(2) > 0
    assert changed.any()
    assert not changed[~editor.region].any()


def test_hair_and_ears_stay(editor, picture):
    from toongeo import FaceLabel

    hair = editor.avatar.parse.mask(FaceLabel.HAIR)
    hair[150:] = False  # the moustache, which moves with the lip
    hair = cv2.erode(hair.astype(np.uint8), np.ones((7, 7), np.uint8)).astype(bool)  # no thin tips
    assert hair.sum() > 1000
    changed = difference(editor.frame({"browOuterUpLeft": 1.0, "browOuterUpRight": 1.0} | OPEN), picture[0]).max(2) > 0
    assert not changed[hair].any()


def test_features_go_where_the_mesh_goes(editor, picture):
    """The drawn outline of the chin lies at the moved chin: the frame sampled there is the picture at the old one."""
    before, after = editor.landmarks(editor.pose), editor.landmarks({"jawLeft": 0.6})
    frame = editor.frame({"jawLeft": 0.6})
    corner = slice(48, 49)
    old, new = np.rint(before[corner]).astype(int)[0], np.rint(after[corner]).astype(int)[0]
    assert np.abs(new - old).max() >= 2
    patches = [img[y - 6 : y + 7, x - 6 : x + 7].mean((0, 1)) for img, (x, y) in ((picture[0], old), (frame, new))]
    assert np.abs(patches[0] - patches[1]).max() < 20


def test_closed_eyes_show_skin_where_the_eye_was(editor, picture):
    frame = editor.frame({"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0})
    landmarks = editor.landmarks(editor.pose)
    for eye in (slice(36, 42), slice(42, 48)):
        x, y = np.rint(landmarks[eye].mean(0)).astype(int)
        skin = np.median(picture[0][y + 25 : y + 35, x - 5 : x + 6], axis=(0, 1))
        assert np.abs(np.median(frame[y - 5 : y + 1, x - 4 : x + 5], axis=(0, 1)) - skin).max() < 45


def test_gaze_is_kept_unless_it_is_named(editor):
    kept = editor.weights(OPEN)
    turned = editor.weights(OPEN | {"eyeLookOutLeft": 1.0})
    assert (kept[46:] == editor.pose[46:]).all()
    assert turned[46:].sum() == 1


def test_a_known_pose_is_the_zero_of_the_motion(picture, avatar):
    posed = ExpressionEditor(*picture, avatar=avatar, pose=OPEN)
    assert np.allclose(posed.vertices(OPEN), avatar.face.vertices, atol=1e-5)


def test_an_edited_picture_is_edited_back(editor, picture):
    """Its face is fitted anew; that it smiles is known, so its rig is that of the face without the smile."""
    weights = editor.weights({"mouthSmileLeft": 0.7, "mouthSmileRight": 0.7, "jawOpen": 0.2})[
        : len(editor.avatar.names)
    ]
    again = ExpressionEditor(editor.frame(weights), editor.landmarks(weights), pose=weights)
    back = again.frame(editor.pose[: len(editor.avatar.names)])
    assert difference(back, picture[0])[editor.region].mean() < 2.2  # of 255


def test_same_input_same_frame(editor):
    assert (editor.frame(OPEN) == editor.frame(OPEN)).all()


def test_a_picture_that_was_changed_is_refused(picture, avatar):
    img = picture[0].copy()
    editor = ExpressionEditor(img, picture[1], avatar=avatar)
    img[0, 0] ^= 255
    with pytest.raises(ValueError, match="img: expected the picture that was fitted"):
        editor.frame(OPEN)


def test_expressions_that_do_not_exist_are_refused(editor):
    with pytest.raises(ValueError, match="did you mean mouthSmileLeft"):
        editor.frame({"mouthSmileLef": 1.0})
    with pytest.raises(ValueError, match="weights: expected"):
        editor.frame(np.zeros(7))
    with pytest.raises(ValueError, match="weights: expected finite"):
        editor.frame({"jawOpen": np.nan})


def test_textures_of_another_size_are_refused(picture, avatar):
    from toongeo import ClassicalTextureGenerator

    small = np.zeros((64, 64, 3), np.uint8)
    editor = ExpressionEditor(
        *picture, avatar=avatar, generator=ClassicalTextureGenerator(avatar.face.model, avatar.rig, small)
    )
    with pytest.raises(ValueError, match="texture: expected 64 x 64 texels"):
        editor.frame(OPEN)


def test_any_generator_gets_lids_and_lashes(picture, editor):
    class Foreign:
        """Keeps the colours as they are, and knows nothing of lids."""

        def __call__(self, texture, source, target, geometry):
            return texture, np.ones(texture.shape[:2], np.float32)

    img, avatar, blink = picture[0], editor.avatar, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
    frames = {
        "default": editor.frame(blink),
        "foreign": ExpressionEditor(*picture, avatar=avatar, generator=Foreign()).frame(blink),
        # The default one behind another type: nothing asks who it is.
        "wrapped": ExpressionEditor(*picture, avatar=avatar, generator=lambda *given: editor._generator(*given)).frame(
            blink
        ),
    }
    assert (frames["wrapped"] == frames["default"]).all()
    # Along the outer edge of a closed upper lid runs a line as dark as the lashes, whatever the texture shows there.
    for side in ("left", "right"):
        row = lid_rings(avatar.face.model, side).upper[2]
        x, y = np.rint(avatar.face.project(editor.vertices(blink)[row[3:-3]])).astype(int).T
        for name in ("default", "foreign"):
            line = frames[name][y, x].astype(float)
            assert np.abs(line - editor._new_skin.lash_colour).max(1).mean() < 60, (side, name)
    assert (frames["foreign"] != img).any()


def test_an_editor_needs_lids_and_a_mouth(picture, avatar):
    bare = replace(avatar, face=replace(avatar.face, model=replace(avatar.face.model, eyes=())))
    with pytest.raises(ValueError, match="avatar: expected one whose model has eyes, uv, mouth_cavity"):
        ExpressionEditor(*picture, avatar=bare)


def test_a_reference_lends_its_expression(cartoon, editor):
    _, landmarks = cartoon("astronaut")
    fit = fit_3dmm(None, landmarks)
    assert reference_weights((None, landmarks)) == fit.expression_weights()
    assert (editor.frame(fit) == editor.frame(fit.expression_weights())).all()


def test_edit_expression_is_one_frame(picture):
    frame = edit_expression(*picture, OPEN)
    assert frame.shape == picture[0].shape
    assert (frame == ExpressionEditor(*picture).frame(OPEN)).all()


def test_bad_arguments(picture):
    with pytest.raises(ValueError, match="expected one of them, got neither"):
        edit_expression(*picture)
    with pytest.raises(ValueError, match="expected one of them, got both"):
        edit_expression(*picture, OPEN, reference=(None, picture[1]))
    with pytest.raises(ValueError, match="reference: no face could be fitted"):
        edit_expression(*picture, reference=(None, np.full((68, 2), np.nan)))
    with pytest.raises(ValueError, match="reference: expected a picture and its landmarks"):
        edit_expression(*picture, reference=3)


def test_a_change_is_added_to_what_the_picture_shows(picture, avatar):
    smile = {"mouthSmileLeft": 0.5, "mouthSmileRight": 0.5}
    editor = ExpressionEditor(*picture, avatar=avatar, pose=smile)
    names = avatar.rig.names
    np.testing.assert_array_equal(editor.added({}), editor.pose)
    more = editor.added({"mouthSmileLeft": 0.3, "mouthSmileRight": 0.9, "jawOpen": -0.5})
    changed = dict(zip(names, more[: len(names)], strict=True))
    assert changed["mouthSmileLeft"] == pytest.approx(0.8)
    assert changed["mouthSmileRight"] == 1.0  # no more than all of it
    assert changed["jawOpen"] == 0.0  # what is not there cannot be taken


def test_relative_weights_of_nothing_leave_the_picture(picture):
    same = difference(edit_expression(*picture, {}, relative=True), picture[0])
    assert same.mean() < 0.3


def test_relative_weights_need_weights(picture):
    with pytest.raises(ValueError, match="relative: expected weights"):
        edit_expression(*picture, reference=picture, relative=True)
