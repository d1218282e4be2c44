"""Hair of one bundled picture, from a mask that is drawn about the head."""

import cv2
import numpy as np
import pytest

from toongeo.pipeline import build_hair, make_room
from toongeo.render import rasterize


def helmet(avatar, shape, grow_px=9, *, below=False):
    """Pixels (H, W) of the head above the brows and around it, as hair would cover them; beside it below, if asked."""
    face = avatar.face
    skin = face.region("skin")
    head = rasterize(face.project(face.vertices), face.faces[skin[face.faces].all(1)], *shape).mask
    brows = int(face.project(face.vertices[face.landmark_vertices[17:27]])[:, 1].min()) - 4
    mask = cv2.dilate(head.astype(np.uint8), np.ones((2 * grow_px + 1,) * 2, np.uint8)) > 0
    mask[brows:] &= below & ~head[brows:]
    mask[int(face.project(face.vertices[face.landmark_vertices[[33]]])[0, 1]) + 20 :] = False
    return mask


@pytest.fixture(scope="session")
def picture(cartoon):
    return cartoon("moustache_man")


@pytest.fixture(scope="session")
def mask(avatar, picture):
    return helmet(avatar, picture[0].shape[:2])


@pytest.fixture(scope="session")
def roomy(avatar, mask):
    """Face and rig that have made room."""
    return make_room(avatar.face, avatar.rig, mask, avatar.parse)


@pytest.fixture(scope="session")
def hair(picture, roomy, mask):
    return build_hair(picture[0], *roomy, mask)
