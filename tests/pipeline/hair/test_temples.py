import numpy as np

from tests.pipeline.hair.conftest import helmet
from toongeo.pipeline import make_room
from toongeo.pipeline.hair.plane.hair_raster import hair_raster
from toongeo.pipeline.hair.plane.working_plane import working_plane
from toongeo.pipeline.hair.shell.regions import head_raster, regions
from toongeo.pipeline.hair.shell.temples import behind_temples, beside_hair


def cells(*rows):
    return np.array([[c == "1" for c in row] for row in rows])


def test_hair_closes_over_skin_between_it_and_the_temple():
    """From both sides inwards, over hair and side skin alike; not over the face, nor past an ear that is seen."""
    hair = cells("1000000000", "1000000101", "0000000000", "1000000001", "0100000000")
    skin = cells("0110000110", "0111001010", "0110000110", "0110000110", "1010000000")
    ears = cells("0000000000", "0000000000", "0000000000", "0000000010", "0000000000")
    expected = cells("0110000000", "0111001010", "0000000000", "0110000000", "0010000000")
    np.testing.assert_array_equal(beside_hair(hair, skin, ears, 5), expected)
    mirrored = beside_hair(hair[:, ::-1], skin[:, ::-1], ears[:, ::-1], 5)
    np.testing.assert_array_equal(mirrored, expected[:, ::-1])


def test_temples_begin_between_ears_and_eyes(model):
    behind = behind_temples(model)
    assert behind[model.region("ears")].all()
    assert not behind[model.landmarks[17:68]].any()
    assert not behind[model.region("eye_left") | model.region("lips") | model.region("nose")].any()
    np.testing.assert_array_equal(behind, behind[model.mirror])


def test_hair_beside_a_head_lies_on_its_side(avatar, picture):
    """Hair that only shows beyond the outline of a head covers the skin behind the temples, without its colours."""
    face, shape = avatar.face, picture[0].shape[:2]
    beside = helmet(avatar, shape, below=True)
    face, _ = make_room(face, avatar.rig, beside)
    plane = working_plane(face, beside)
    raster = hair_raster(plane, beside, np.ones(plane.shape, bool))
    head = head_raster(face, plane, face.vertices)
    parts = regions(face, plane, raster, head)
    covered = parts.front & ~parts.pictured
    X = plane.cells(plane.of(face.vertices[face.landmark_vertices])[:, :2])
    rows = slice(int(X[33, 1]), int(X[19, 1]))  # nose to brows
    for side in (slice(0, int(X[36, 0])), slice(int(X[45, 0]), None)):
        assert covered[rows, side].any(1).mean() > 0.15
    assert not (parts.front[rows, int(X[36, 0]) : int(X[45, 0])]).any()
    assert not (parts.pictured & covered).any()
    assert parts.back[head.crown].all()  # tufts are cut out of hair that hangs, not out of what lies on the head
