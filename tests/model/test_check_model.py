"""Models whose arrays do not fit together."""

import numpy as np
import pytest

from toongeo.model import MorphableModel


def arrays(**changed):
    """A model of five vertices."""
    mean = np.random.default_rng(0).normal(size=(5, 3))
    given = {
        "mean": mean,
        "faces": np.array([[0, 1, 2], [2, 3, 4]]),
        "identity": np.zeros((2, 5, 3), np.float32),
        "landmarks": np.arange(68) % 5,
        "expression": np.zeros((1, 5, 3), np.float32),
        "expression_names": ("jawOpen",),
        "n_named": 1,
    }
    return given | changed


def changed(array, value):
    array = np.array(array)
    array.flat[-1] = value
    return array


def test_a_whole_model_passes():
    assert MorphableModel(**arrays()).has("jawOpen")


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        *(
            (name, changed(arrays()[name], bad), f"{name}: expected finite numbers, got NaN or infinity")
            for name in ("mean", "identity", "expression")
            for bad in (np.nan, np.inf)
        ),
        ("mean", np.zeros((5, 2)), r"mean: expected shape \(k, 3\), got \(5, 2\)"),
        ("mean", np.array([["a"] * 3] * 5), "mean: expected numbers, got <U1"),
        ("identity", np.zeros((2, 4, 3)), r"identity: expected shape \(k, 5, 3\), got \(2, 4, 3\)"),
        ("identity", np.zeros((2, 5, 3), complex), "identity: expected numbers, got complex128"),
        ("faces", changed(arrays()["faces"], 5), "faces: expected vertices in 0..4, got 0 to 5"),
        ("faces", changed(arrays()["faces"], -1), "faces: expected vertices in 0..4, got -1 to 3"),
        ("faces", arrays()["faces"] + 0.5, "faces: expected indices, got float64"),
        ("landmarks", np.arange(68), "landmarks: expected vertices in 0..4, got 0 to 67"),
        ("landmarks", np.zeros(60, int), "landmarks: expected 68 rows, got 60"),
        ("expression_names", (), None),
        ("expression_names", ("a", "b"), "expression_names: expected one for each of 1 modes, got 2 names"),
        ("n_named", 2, "expression_names: expected one for each of 1 modes, got 1 names of which 2"),
        ("uv_faces", np.zeros((2, 3), int), "uv_faces: expected texture coordinates in 0..-1, got 0 to 0"),
        ("mirror", np.arange(4), "mirror: expected 5 rows, got 4"),
        ("regions", {"skin": np.ones(4, bool)}, r"regions: expected \(5,\) truth values in 'skin', got \(4,\)"),
    ],
)
def test_what_does_not_fit_is_named(name, value, message):
    if message is None:
        MorphableModel(**arrays(**{name: value}))
        return
    with pytest.raises(ValueError, match=message):
        MorphableModel(**arrays(**{name: value}))
