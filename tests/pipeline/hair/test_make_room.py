import dataclasses

import numpy as np

from toongeo.pipeline import build_hair, hair_faults, make_room


def test_what_is_seen_stays_and_face_and_rig_move_alike(avatar, roomy, mask):
    face, rig = roomy
    moved = face.vertices - avatar.face.vertices
    np.testing.assert_allclose(rig.neutral - avatar.rig.neutral, moved, atol=1e-9)
    px = np.rint(avatar.face.project(avatar.face.vertices)).astype(int)
    px = np.clip(px, 0, np.array(mask.shape[::-1]) - 1)
    still = avatar.face.landmark_vertices
    shown = still[~mask[px[still, 1], px[still, 0]]]
    assert np.linalg.norm(moved[shown], axis=1).max() <= 0.1
    np.testing.assert_array_equal(rig.deltas, avatar.rig.deltas)


def test_a_crown_taller_than_the_hair_sinks(avatar, mask):
    """Of a mask that ends lower, the skull ends lower, too, by as much."""
    rows = np.flatnonzero(mask.any(1))
    low = mask.copy()
    low[: rows[0] + 40] = False
    face, _ = make_room(avatar.face, avatar.rig, low, avatar.parse)
    scalp = face.region("scalp")
    top = face.project(face.vertices[scalp])[:, 1].min()
    assert rows[0] + 40 <= top <= rows[0] + 40 + 12


def test_a_face_is_no_broader_than_what_strands_beside_it_leave(avatar, mask):
    """Below the eyes a strand of 7 mm over the outline of the cheek stands beside the head, not before it."""
    face = avatar.face
    jaw = face.vertices[face.landmark_vertices[[2, 14]]]  # at the height of the nose
    px = np.rint(face.project(jaw)).astype(int)
    per_mm = np.abs(px[1, 0] - px[0, 0]) / np.linalg.norm(jaw[1] - jaw[0])
    wide = mask.copy()
    inner = round(7 * per_mm)
    top = np.flatnonzero(mask.any(1))[-1]
    wide[top : px[:, 1].max(), : px[0, 0] + inner] = wide[top : px[:, 1].max(), px[1, 0] - inner :] = True
    moved = make_room(face, avatar.rig, wide)[0].vertices - make_room(face, avatar.rig, mask)[0].vertices
    side = face.region("face") & (np.abs(face.vertices[:, 1] - jaw[:, 1].mean()) < 8)
    outermost = side & (np.abs(face.vertices[:, 0]) > 0.95 * np.abs(face.vertices[side, 0]).max())
    inwards = -moved[outermost, 0] * np.sign(face.vertices[outermost, 0])
    assert inwards.mean() > 2.0
    middle = side & (np.abs(face.vertices[:, 0]) < 20)
    assert np.abs(moved[middle]).max() < 0.1


def test_no_hair_no_room(avatar, mask):
    face, rig = make_room(avatar.face, avatar.rig, np.zeros_like(mask), avatar.parse)
    assert face is avatar.face
    assert rig is avatar.rig


def test_faults_of_masks(avatar, picture, mask):
    shape = picture[0].shape[:2]
    assert hair_faults(avatar.face, mask) == ()
    corner = np.zeros(shape, bool)
    corner[-20:, :20] = True
    wreath = mask.copy()
    columns = np.flatnonzero(mask.any(0))
    wreath[:, columns[len(columns) // 8] : columns[-len(columns) // 8]] = False
    for bad, reason in (
        (np.zeros(shape, bool), "no hair"),
        (np.ones(shape, bool), "covers the face"),
        (corner, "near the head"),
        (wreath, "crown"),
    ):
        (found,) = hair_faults(avatar.face, bad)
        assert reason in found, found


def test_a_model_without_a_scalp(avatar, mask):
    regions = {name: rows for name, rows in avatar.face.model.regions.items() if name != "scalp"}
    plain = dataclasses.replace(avatar.face, model=dataclasses.replace(avatar.face.model, regions=regions))
    assert hair_faults(plain, mask) == ("the model has no region scalp",)


def test_two_blobs_are_the_one_on_the_head(avatar, picture, mask):
    """A second piece that is no hair of this head changes nothing."""
    second = mask.copy()
    second[-12:, -12:] = True
    face, rig = make_room(avatar.face, avatar.rig, mask, avatar.parse)
    other, _ = make_room(avatar.face, avatar.rig, second, avatar.parse)
    np.testing.assert_allclose(other.vertices, face.vertices, atol=1e-6)
    one, two = build_hair(picture[0], face, rig, mask), build_hair(picture[0], face, rig, second)
    assert abs(len(one.faces) - len(two.faces)) < 0.05 * len(one.faces)
