"""The table of the 68 points: a partition into parts, and a mirror that keeps faces faces."""

import numpy as np
import pytest

from toongeo.io import read_landmarks
from toongeo.model import data_path, default_model
from toongeo.model.ibug68 import INNER, MIRROR, NAMES, OUTER_EYES, PARTS


def test_parts_are_a_partition():
    assert sorted(np.concatenate(list(PARTS.values()))) == list(range(68))
    assert {name: len(part) for name, part in PARTS.items()} == {
        "jaw": 17, "brow_right": 5, "brow_left": 5, "nose": 9, "eye_right": 6, "eye_left": 6, "mouth": 20,
    }  # fmt: skip
    np.testing.assert_array_equal(INNER, np.arange(17, 68))
    assert len(set(NAMES)) == 68


def test_mirror_is_an_involution_that_exchanges_the_sides():
    np.testing.assert_array_equal(MIRROR[MIRROR], np.arange(68))
    for part, points in PARTS.items():
        other = part.replace("right", "@").replace("left", "right").replace("@", "left")
        assert set(MIRROR[points]) == set(PARTS[other])
    middle = [8, 27, 28, 29, 30, 33, 51, 57, 62, 66]
    np.testing.assert_array_equal(np.flatnonzero(np.arange(68) == MIRROR), middle)


@pytest.mark.parametrize("picture", ["astronaut", "moustache_man"])
def test_a_mirrored_frontal_face_is_nearly_itself(picture):
    points = read_landmarks(data_path(f"examples/portraits/{picture}.pts"))
    centred = points - points.mean(axis=0)
    mirrored = (centred * [-1, 1])[MIRROR]
    assert np.abs(mirrored - centred).max() < 0.15 * np.linalg.norm(np.subtract(*points[list(OUTER_EYES)]))


def test_the_default_model_agrees():
    model = default_model()
    np.testing.assert_array_equal(model.mirror[model.landmarks], model.landmarks[MIRROR])


def test_tables_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        MIRROR[0] = 1
    with pytest.raises(TypeError, match="does not support item assignment"):
        PARTS["jaw"] = INNER
