"""What a test gets from another process is what it would have made itself."""

import numpy as np
import pytest

from tests.sharing import Once


def made(model, rng):
    kept = rng.random((4, 3))
    kept.setflags(write=False)
    arrays = {"kept": kept, "free": rng.random(5), "columns": np.asfortranarray(rng.random((3, 4))), "none": kept[:0]}
    return {**arrays, "turned": kept.T[::2], "number": 0.1 + 0.2, "model": model, "eye": model.eyes[1]}


def test_another_process_gets_the_same_bits_and_the_template_itself(model, rng, tmp_path):
    first = Once(tmp_path)("thing", lambda: made(model, rng))
    other = Once(tmp_path)
    second = other("thing", lambda: pytest.fail("made again"))
    assert list(second) == list(first) and other("thing", None) is second
    for name, array in first.items():
        if isinstance(array, np.ndarray):
            assert (second[name].dtype, second[name].shape) == (array.dtype, array.shape)
            np.testing.assert_array_equal(second[name], array)
    for name in ("kept", "free", "columns"):
        assert second[name].flags.writeable is first[name].flags.writeable
    assert second["number"] == first["number"]
    assert second["model"] is model and second["eye"] is model.eyes[1]


def test_what_could_not_be_made_is_made_by_the_next(tmp_path):
    with pytest.raises(ZeroDivisionError):
        Once(tmp_path)("thing", lambda: 1 / 0)
    assert Once(tmp_path)("thing", lambda: 7) == Once(tmp_path)("thing", lambda: 8) == 7


def test_one_process_alone_makes_it_once():
    calls = []
    once = Once(None)
    assert [once("thing", lambda: calls.append(1) or len(calls)) for _ in range(2)] == [1, 1]
