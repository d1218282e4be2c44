"""Arrays of points."""

import numpy as np

from toongeo.driving.landmarks.landmark_frames import landmark_frames
from toongeo.io import landmark_array
from toongeo.io.point_array import point_array


def test_what_a_masked_array_hides_is_missing():
    points = np.ma.masked_array(np.arange(136).reshape(68, 2), mask=False)
    points[:5] = np.ma.masked
    expected = np.arange(136.0).reshape(68, 2)
    expected[:5] = np.nan
    for found in (point_array(points), landmark_array(points), landmark_frames(points)[0]):
        assert type(found) is np.ndarray and found.dtype == np.float64
        np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(point_array(np.ma.masked_array([[1, 2]])), [[1.0, 2.0]])
