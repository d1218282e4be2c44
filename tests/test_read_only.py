"""Arrays of frozen dataclasses cannot be written to, in copies neither."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

from toongeo._read_only import read_only, restored


@dataclasses.dataclass(frozen=True, eq=False)
class Part:
    points: np.ndarray
    parts: tuple
    table: dict
    name: str = "nose"

    __setstate__ = restored

    def __post_init__(self):
        read_only(self, "points", "parts", "table")


@pytest.mark.parametrize("copied", [lambda x: x, copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
def test_copies_and_pickles_are_read_only(copied):
    given = np.arange(6.0)
    part = copied(Part(given, (np.zeros(2), None), {"a": np.ones(3)}))
    np.testing.assert_array_equal(part.points, np.arange(6.0))
    assert part.parts[1] is None and part.name == "nose"
    for array in (part.points, part.parts[0], part.table["a"]):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7
    given[0] = 1  # what was given stays writable


def test_an_avatar_in_another_process_is_read_only(avatar):
    again = pickle.loads(pickle.dumps(dataclasses.replace(avatar.fit, model=None)))
    np.testing.assert_array_equal(again.identity, avatar.fit.identity)
    assert not again.identity.flags.writeable and not again.camera.rotation.flags.writeable
