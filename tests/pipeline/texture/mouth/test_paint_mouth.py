import numpy as np
import pytest

from toongeo.pipeline.parse.drawn_mouth import DrawnMouth
from toongeo.pipeline.texture.bake_texture import _atlas_fragments
from toongeo.pipeline.texture.mouth.paint_mouth import paint_mouth
from toongeo.render import rasterize

SIZE = 256
BLUE, GREEN = np.array([0, 0, 255.0]), np.array([0, 255.0, 0])


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("astronaut")  # smiles, with open lips


@pytest.fixture(scope="module")
def painted(face, cartoon):
    """A picture whose teeth are blue where the head has teeth, and green in the rest of the opening."""
    height, width = cartoon("astronaut")[0].shape[:2]
    depth = face.camera.depth(face.vertices)
    ids = rasterize(np.column_stack([face.project(face.vertices), depth]), face.faces, height, width).face_ids
    part = {name: face.region(name)[face.faces].all(1) for name in ("teeth_upper", "tongue", "mouth_cavity")}
    teeth = (ids >= 0) & part["teeth_upper"][ids]
    inside = teeth | ((ids >= 0) & (part["tongue"] | part["mouth_cavity"])[ids])
    assert np.count_nonzero(teeth) > 50
    img = np.zeros((height, width, 3), np.uint8)
    img[inside], img[teeth] = GREEN, BLUE
    mouth = DrawnMouth(inside, teeth, np.zeros_like(teeth), float(np.ptp(np.nonzero(inside)[1])))
    atlas = _atlas_fragments(face.model, SIZE)
    grey = np.full((SIZE, SIZE, 3), 128, np.uint8)
    return grey, atlas, paint_mouth(grey, atlas, img, face, mouth)


def texels(face, atlas, part):
    return atlas.mask & face.region(part)[face.faces].all(1)[atlas.face_ids]


def test_teeth_take_teeth_and_what_is_beside_them_does_not(face, painted):
    _, atlas, texture = painted
    teeth = texture[texels(face, atlas, "teeth_upper")].astype(float)
    assert (teeth[:, 2] > 250).sum() >= 4 and (teeth[:, 1] <= 128).all()
    for part in ("tongue", "mouth_cavity"):
        assert (texture[texels(face, atlas, part)][:, 2] <= 160).all(), (
            part
        )  # at the border of the class pixels are mixed


def test_only_the_inside_of_the_mouth_is_painted(face, painted):
    grey, atlas, texture = painted
    inner = np.any([texels(face, atlas, part) for part in ("teeth_upper", "teeth_lower", "tongue", "mouth_cavity")], 0)
    np.testing.assert_array_equal(texture[~inner], grey[~inner])
    assert (texture[inner] != grey[inner]).any()


def test_a_closed_mouth_leaves_the_atlas_alone(face, painted):
    grey, atlas, _ = painted
    assert paint_mouth(grey, atlas, np.zeros((4, 4, 3), np.uint8), face, None) is grey
