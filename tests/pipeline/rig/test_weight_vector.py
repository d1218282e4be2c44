import numpy as np
import pytest

from toongeo.pipeline.rig.weight_vector import weight_vector

NAMES = ("eyeBlinkLeft", "eyeBlinkRight", "jawOpen")


def test_mapping_array_and_none_agree():
    np.testing.assert_array_equal(weight_vector({"jawOpen": 0.5}, NAMES), weight_vector([0, 0, 0.5], NAMES))
    np.testing.assert_array_equal(weight_vector(None, NAMES), np.zeros(3))


def test_bad_weights_are_refused():
    with pytest.raises(ValueError, match=r"weights: no expression 'jawopen'; did you mean jawOpen"):
        weight_vector({"jawopen": 1.0}, NAMES)
    with pytest.raises(ValueError, match="weights: expected 3 values, got shape"):
        weight_vector(np.zeros(46), NAMES)
    with pytest.raises(ValueError, match="weights: no expression 'zzz'$"):
        weight_vector({"zzz": 1.0}, NAMES)
    with pytest.raises(ValueError, match="weights: no expression 0"):
        weight_vector({0: 1.0}, NAMES)
    with pytest.raises(ValueError, match="weights: expected a number for jawOpen, got '1'"):
        weight_vector({"jawOpen": "1"}, NAMES)
    with pytest.raises(ValueError, match="weights: expected finite values"):
        weight_vector({"jawOpen": np.nan}, NAMES)


@pytest.mark.parametrize("weight", [10**400, 1e300, -1e39, 1.1e6])
def test_weights_beyond_what_float32_can_show_are_refused(weight):
    with pytest.raises(ValueError, match="weights: expected (values up to 1e\\+06|a number for a, got one beyond all)"):
        weight_vector({"a": weight}, ["a"])
    with pytest.raises(ValueError, match="weights: expected"):
        weight_vector([weight], ["a"])
