"""A few hostile inputs in every run; thousands by ``benchmarks/fuzz.py``."""

import sys
import warnings

import pytest

from tests.conftest import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))
import fuzz
import fuzz_inputs

READERS = fuzz_inputs.targets()


@pytest.mark.parametrize("name", READERS)
def test_readers_keep_their_promise(tmp_path, name):
    target = READERS[name]
    path = tmp_path / f"a{target.suffix}"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for content in target.good:
            path.write_bytes(content)
            target.read(path)  # what is mutated was good
        for number in range(10):
            assert fuzz.fault(target, path, fuzz_inputs.hostile(target, number, name)) is None, number


@pytest.mark.parametrize("name", fuzz.verbs())
def test_functions_of_geometry_give_finite_results_or_say_why_not(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number in range(10):
            assert fuzz.mesh_fault(fuzz.verbs()[name], number) is None, number


def test_a_broken_promise_is_noticed(tmp_path):
    def leak(path):
        raise KeyError("points")

    def nameless(path):
        raise ValueError("cannot reshape array")

    for read, why in ((leak, "KeyError"), (nameless, "names nothing"), (lambda path: float("nan"), "gives NaN")):
        target = fuzz_inputs.Target(".a", read, (b"a",), fuzz_inputs._only)
        assert why in fuzz.fault(target, tmp_path / "a.a", b"b")
    assert "gives NaN" in fuzz.mesh_fault(lambda V, F: V * float("nan"), 8)
    assert fuzz_inputs.hostile(READERS["obj"], 5, "obj") == fuzz_inputs.hostile(READERS["obj"], 5, "obj")
