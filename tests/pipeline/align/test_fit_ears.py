import dataclasses

import cv2
import numpy as np
import pytest

from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.fit_ears import fit_ears
from toongeo.protocols import FaceLabel, FaceParse

SHAPE = (560, 620)


@pytest.fixture(scope="module")
def face(aligned):
    """With room around it in its picture."""
    face = aligned("moustache_man")
    return dataclasses.replace(face, camera=face.camera.cropped([-60, -40], 1.0))


def grown(face, sides, size):
    """The face with ears grown about the middles of their vertices' inner ends."""
    V = face.vertices.copy()
    for side in sides:
        ear = face.region(f"ear_{side}")
        pivot = V[ear][np.abs(V[ear, 0]).argmin()]
        V[ear] = pivot + size * (V[ear] - pivot)
    return dataclasses.replace(face, vertices=V)


def parsed(face, sides):
    labels = np.full(SHAPE, FaceLabel.BACKGROUND, np.uint8)
    px = face.project(face.vertices)
    skin = cv2.convexHull(np.rint(px[face.region("face")]).astype(np.int32))
    for side in sides:
        hull = cv2.convexHull(np.rint(px[face.region(f"ear_{side}")]).astype(np.int32))
        cv2.fillConvexPoly(labels, hull, int(FaceLabel.EARS))
    cv2.fillConvexPoly(labels, skin, int(FaceLabel.SKIN))
    for side in sides:
        hull = cv2.convexHull(np.rint(px[face.region(f"ear_{side}")]).astype(np.int32))
        cv2.fillConvexPoly(labels, hull, int(FaceLabel.EARS))
    return FaceParse(labels, np.ones(SHAPE, np.float32))


def heights(face):
    px = face.project(face.vertices)
    return np.array([np.ptp(px[face.region(f"ear_{side}"), 1]) for side in SIDES])


@pytest.mark.parametrize("size", [1.2, 1.6])
def test_ears_get_the_height_of_those_drawn(face, size):
    fitted = fit_ears(face, parsed(grown(face, SIDES, size), SIDES))
    np.testing.assert_allclose(heights(fitted) / heights(face), size, rtol=0.13)  # at the root they follow the head


def test_only_ears_move_and_keep_their_shape(face):
    fitted = fit_ears(face, parsed(grown(face, SIDES, 1.5), SIDES))
    np.testing.assert_array_equal(fitted.vertices[~face.region("ears")], face.vertices[~face.region("ears")])
    for side in SIDES:
        ear = face.region(f"ear_{side}")
        before, after = (X.vertices[ear] - X.vertices[ear].mean(0) for X in (face, fitted))
        stretches = np.linalg.svd(np.linalg.lstsq(before, after, rcond=None)[0], compute_uv=False)
        assert stretches[0] / stretches[-1] < 1.35


def test_an_ear_that_is_not_seen_is_as_the_other(face):
    fitted = fit_ears(face, parsed(grown(face, SIDES, 1.5), SIDES[:1]))
    both = heights(fitted) / heights(face)
    assert both.min() > 1.3 and abs(both[0] - both[1]) < 0.15


def test_ears_that_are_not_drawn_stay(face):
    assert fit_ears(face, parsed(face, ())) is face
    sideburn = parsed(face, ()).labels.copy()
    at = np.rint(face.project(face.vertices[face.landmark_vertices[[0]]])[0]).astype(int)
    sideburn[at[1] - 6 : at[1] + 6, at[0] - 2 : at[0] + 2] = FaceLabel.EARS
    assert fit_ears(face, FaceParse(sideburn, np.ones(SHAPE, np.float32))) is face
